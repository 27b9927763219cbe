# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line: ``python3 -m pkm_post`` or the console script ``pkm-post``."""

import sys

from pkm_post.cli import main


def run() -> int:
    """Run with the arguments of the process; its exit code."""
    return main(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(run())
