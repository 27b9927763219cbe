# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write into ``rs274.txt`` what rs274, the interpreter of LinuxCNC, makes of its programs.

    python3 tests/reading/corpus/golden.py    needs rs274 (Debian: linuxcnc-uspace)

Programs whose moves are written by hand, with their source, or that are refused, stay as they are.
"""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "oracles")]

from corpus import HEADS, as_row, sections, without_repeats  # noqa: E402 - the path comes first
from rs274_moves import rs274  # noqa: E402


def golden(program):
    """The moves of rs274, as rows."""
    found = rs274(f"{HEADS['rs274']}{program}M2\n")
    return "; ".join(without_repeats([as_row(kind, place) for kind, place, _, _ in found]))


def main():
    file = HERE / "rs274.txt"
    parts = [file.read_text(encoding="utf-8").split("\n== ", 1)[0].rstrip() + "\n"]
    for section in sections(file):
        rows = section.expected if section.by_hand else golden(section.program)
        parts.append(f"== {section.title}\n{section.program}-> {rows}\n")
    file.write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main()
