# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line: ``python3 -m pkm_post`` or the console script ``pkm-post``."""

import gc
import os
import sys

gc.set_threshold(100_000, 20, 20)  # hardly any of the many objects that imports make is garbage
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # threads of our own share the work; those would only wait busily

from pkm_post.cli import main  # noqa: E402 - NumPy reads the variable when it is loaded


def run() -> int:
    """Run with the arguments of the process; its exit code."""
    code = main(sys.argv[1:])
    gc.freeze()  # at the exit Python would search all that was imported for cycles
    return code


if __name__ == "__main__":
    sys.exit(run())
