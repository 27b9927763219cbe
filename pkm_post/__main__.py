# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line: ``python3 -m pkm_post`` or the console script ``pkm-post``."""

import gc
import os
import sys

gc.set_threshold(100_000, 20, 20)  # imports create many objects, hardly any of them garbage
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # we have our own threads; those of OpenBLAS would only spin


def run() -> int:
    """Run with the command line of the process; return the exit code, 130 if Ctrl-C comes during the imports."""
    try:
        from pkm_post.cli import main

        code = main(sys.argv[1:])
    except KeyboardInterrupt:
        return 130
    gc.freeze()  # else Python searches all imported objects for cycles at exit
    return code


if __name__ == "__main__":
    sys.exit(run())
