# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compare series of canned cycles with rs274, the interpreter of LinuxCNC, on programs made at random.

    python3 tests/oracles/cycles_rs274.py [PROGRAMS]    how many to compare
    python3 tests/oracles/cycles_rs274.py --golden      writes tests/data/cycles_rs274.json

Needs rs274 (Debian: linuxcnc-uspace), numpy and lark. Compared are moves, dwells and whether the spindle turns.

Where the tool stands at R or below and the next hole is higher, or is to be left at the initial level, rs274 goes up
and across in one rapid. Its manual has it go up first (G-codes, canned cycles, preliminary motion), and so do we: such
a rapid of rs274 is taken for two.
"""

import json
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests" / "data" / "cycles_rs274.json"
sys.path[:0] = [str(ROOT), str(Path(__file__).parent)]

from gcode_rs274 import PRINTED, options  # noqa: E402 - the path comes first
from random_cycles import cam_program, program  # noqa: E402
from rs274_moves import CALL, Machine, numbers, output_of  # noqa: E402

CASES, CAM_CASES = 180, 70
TOLERANCE = 0.006
"""mm: rs274 prints four decimals, of inches as well."""
DWELL, SPINDLE = 4, 5
SPINDLE_CALLS = {"START_SPINDLE_CLOCKWISE": 1.0, "STOP_SPINDLE_TURNING": 0.0}


def theirs(text):
    """What rs274 does, rows [kind, x, y, z] in mm with kind 0 rapid or 1 line, [4, s] and [5, 1 or 0]; or None."""
    output = output_of(text)
    if output is None:
        return None
    machine, rows, before = Machine(), [], np.zeros(3)
    for _, name, words in (match.groups() for match in map(CALL.match, output.splitlines()) if match):
        if name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED"):
            kind, point = int(name == "STRAIGHT_FEED"), np.array(numbers(words)[:3])
            across, rise = machine.axes[:2], point - before
            if not kind and rise[machine.axes[2]] > PRINTED and np.abs(rise[list(across)]).max() > PRINTED:
                above = np.array(before)
                above[machine.axes[2]] = point[machine.axes[2]]
                rows.append([kind, *machine.place(above * machine.scale)])
            rows.append([kind, *machine.place(point * machine.scale)])
            before = point
        elif name == "DWELL":
            rows.append([DWELL, numbers(words)[0]])
        elif name in SPINDLE_CALLS:
            rows.append([SPINDLE, SPINDLE_CALLS[name]])
        elif name == "PROGRAM_END":
            break
        else:
            before = machine.shifted(name, words, before)
    return plain(rows)


def ours(text):
    """The same of the reader, or None; and its diagnostics."""
    from pkm_post.reading.gcode import read

    given, faults = read(text, "part.ngc", options())
    return None if given is None else rows_of(given), faults


def rows_of(given):
    """A program as ``theirs`` has it."""
    from pkm_post.model import EventKind

    rows, events = [], list(given.events)
    for row in range(len(given) + 1):
        while events and events[0].row == row:
            event = events.pop(0)
            if event.kind is EventKind.DWELL:
                rows.append([DWELL, event.value])
            elif event.kind is EventKind.SPINDLE:
                rows.append([SPINDLE, float(event.value > 0)])
        if row < len(given):
            rows.append([int(given.kind[row]), *given.position[row].tolist()])
    return plain(rows)


def plain(rows):
    """Rows without moves that stay in place, spindle that goes on, and the stop at the end."""
    kept, here, turns = [], np.full(3, np.inf), 0.0
    for kind, *values in rows:
        if kind < DWELL:
            if np.abs(here - values).max() < TOLERANCE:
                continue
            here = np.array(values)
        elif kind == SPINDLE:
            if values[0] == turns:
                continue
            turns = values[0]
        kept.append([kind, *(short(value) for value in values)])
    return kept[:-1] if kept and kept[-1] == [SPINDLE, 0.0] else kept


def short(value):
    """A number of three decimals, without a point where it is whole: that many are in the file."""
    value = round(float(value), 3)
    return int(value) if value.is_integer() else value


def difference(expected, found):
    """Words for the first row that differs, empty if there is none."""
    for row, (one, other) in enumerate(zip(expected, found, strict=False)):
        if one[0] != other[0] or np.abs(np.subtract(one[1:], other[1:])).max() > TOLERANCE:
            return f"row {row}: {other} where rs274 has {one}"
    return "" if len(expected) == len(found) else f"{len(found)} rows where rs274 has {len(expected)}"


def as_rs274(text):
    """A program of CAM commands with what rs274 has to be given."""
    return f"G21 G90 G17 G98 F300\n{text}"


def compare(count):
    different = refused = 0
    for seed in range(count):
        for text in (program(seed), as_rs274(cam_program(seed))):
            expected, (found, faults) = theirs(text), ours(text)
            refused += expected is None
            if expected is None or found is None:
                why = "" if expected is found else f"taken by rs274: {expected is not None}, ours: {faults}"
            else:
                why = difference(expected, found)
            if why:
                different += 1
                if different < 4:
                    print(f"seed {seed}: {why}\n{text}")
    print(f"{2 * count} programs, {refused} refused by rs274, {different} different")
    return different


def write_golden():
    texts = [(program(seed), False) for seed in range(CASES)]
    texts += [(cam_program(seed), True) for seed in range(CAM_CASES)]
    rows = [
        json.dumps(
            {"program": text, "cam": cam, "rows": theirs(as_rs274(text) if cam else text)}, separators=(",", ":")
        )
        for text, cam in texts
    ]
    GOLDEN.write_text("[\n" + ",\n".join(rows) + "\n]\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    if sys.argv[1:] == ["--golden"]:
        write_golden()
    else:
        sys.exit(bool(compare(int(sys.argv[1]) if len(sys.argv) > 1 else 200)))
