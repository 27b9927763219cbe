# SPDX-License-Identifier: LGPL-2.1-or-later
"""``python3 -m pkm_post``."""

import sys

from pkm_post.cli import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
