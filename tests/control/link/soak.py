# SPDX-License-Identifier: LGPL-2.1-or-later
"""Thousands of sessions and downloads with faults, and a stream for every 50: ``make soak``. A seed gives the same.

python3 tests/control/link/soak.py [HOW_MANY [FIRST_SEED]]
"""

import logging
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

import sessions  # noqa: E402
import streams  # noqa: E402
from link_faults import by_chance, reference_of, small_program  # noqa: E402

DOWNLOADS_PER_STREAM = 50


def main(count=10_000, first=0):
    """Try so many; the first that breaks a rule ends it with its seed."""
    logging.disable(logging.CRITICAL)
    program = small_program()
    reference = reference_of(program)

    def downloaded(seed):
        fault, outcome = by_chance(seed, program, reference)
        return fault, outcome.what

    _tell(sessions.by_chance, count, first)
    print(f"{count} sessions: the machine rested, or moved as was certified")
    _tell(downloaded, count, first)
    print(f"{count} downloads: each ended in the program as it was sent, or in an error that says what is left")
    _tell(streams.by_chance, count // DOWNLOADS_PER_STREAM, first)
    print(f"{count // DOWNLOADS_PER_STREAM} streams: the struts stopped where the program rests, and nowhere else")


def _tell(tried, count, first):
    ends = Counter()
    for seed in range(first, first + count):
        try:
            ends[tried(seed)] += 1
        except BaseException:
            print(f"seed {seed}", file=sys.stderr)
            raise
    for (what, end), times in sorted(ends.items()):
        print(f"{what:16} {end:20} {times:6}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
