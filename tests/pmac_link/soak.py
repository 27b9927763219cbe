# SPDX-License-Identifier: LGPL-2.1-or-later
"""Thousands of downloads with faults: ``make soak``. The same seeds give the same faults.

python3 tests/pmac_link/soak.py [FAULTS [FIRST_SEED]]
"""

import logging
import sys
from collections import Counter

from link_faults import by_chance, reference_of, small_program


def main(count=10_000, first=0):
    """Try so many; the first that breaks a rule ends it with its seed."""
    logging.disable(logging.CRITICAL)
    program = small_program()
    reference, ends = reference_of(program), Counter()
    for seed in range(first, first + count):
        try:
            fault, outcome = by_chance(seed, program, reference)
        except BaseException:
            print(f"seed {seed}", file=sys.stderr)
            raise
        ends[fault, outcome.what] += 1
    for (fault, what), times in sorted(ends.items()):
        print(f"{fault:14} {what:10} {times:6}")
    print(f"{count} downloads: each ended in the program as it was sent, or in an error that says what is left")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
