# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plays for long, with bad luck, and over real links: ``make soak`` has the latter two.

    PYTHONPATH=. python3 tests/control/player/soak.py luck [HOW_MANY [FIRST_SEED]]
    PYTHONPATH=. python3 tests/control/player/soak.py links [ROWS [SEED]]
    PYTHONPATH=. python3 tests/control/player/soak.py play out/tapered_column.pkmt tcp|serial|ssh [SEED]
    PYTHONPATH=. python3 tests/control/player/soak.py long [ROWS]

``luck`` draws faults by seeds (``bad_luck``). ``links`` plays a short spiral over each of the three links, ``play`` a
posted trajectory over one of them step by step (``behind_links``), with an operator who never rests (``operated``).
``links`` is in real time. ``long`` plays a spiral of many short lines without a rest, step by step, and looks at what
the process needs of memory meanwhile.
"""

import logging
import resource
import sys
import time
from collections import Counter
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[level] / room) for level, room in ((2, ""), (1, "link"), (0, "."))]

import bad_luck  # noqa: E402
import numpy as np  # noqa: E402
import operated  # noqa: E402
from playing import SMOOTH, TOLERANCES, trajectory_of  # noqa: E402
from station import MACHINE  # noqa: E402

from pkm_post.control.player.playable import read_playable  # noqa: E402

CHORD_MM, PITCH_MM, FEED = 0.4, 1.5, 46.0
"""Of the spiral; with 42,000 rows it takes six minutes."""
MOST_GROWTH_MIB = 64
"""By which the process may grow after the first tenth of a play, whatever its length."""


def luck(count="60", first="0"):
    """So many plays with bad luck; the first that breaks a rule ends it with its seed."""
    ends = Counter()
    for seed in range(int(first), int(first) + int(count)):
        try:
            ends[bad_luck.by_chance(seed)] += 1
        except BaseException:
            print(f"seed {seed}", file=sys.stderr)
            raise
    for (what, end), times in sorted(ends.items()):
        print(f"{what:16} {end:20} {times:6}")
    print(f"{count} plays: the tool stayed on the path, and came to rest on it or arrived")


def play(file, kind="tcp", seed="1"):
    """A posted trajectory."""
    trajectory, tolerances, faults = read_playable(Path(file), MACHINE)
    assert trajectory is not None, faults
    _report(*operated.play_operated(trajectory, tolerances, kind, int(seed)))


def links(rows="1000", seed="1"):
    """A short spiral over TCP, a pseudo terminal and ssh; some things happen on the way, an abort at last.

    And once more with tight limits of jerk, without an abort, which keeps none.
    """
    happens = {"seed": int(seed), "holds": 3, "overrides": 4, "is_in_step": False}
    for kind in ("tcp", "serial", "ssh"):
        print(f"over {kind}:", flush=True)
        follower, operator, results = operated.play_operated(spiral(int(rows)), TOLERANCES, kind, **happens)
        assert operator.done[-1] == "abort", "the program was too short for all of it"
        _report(follower, operator, results)
    print("with tight limits of jerk, over tcp:", flush=True)
    played = operated.play_operated(spiral(int(rows)), TOLERANCES, "tcp", machine=SMOOTH, aborts=0, **happens)
    _report(*played, machine=SMOOTH)


def long(rows="42000"):
    """A spiral without a rest, over TCP; nothing else happens."""
    nothing = {"holds": 0, "overrides": 0, "breaks": 0, "aborts": 0}
    _report(*operated.play_operated(spiral(int(rows)), TOLERANCES, "tcp", **nothing))


def spiral(rows):
    """A spiral over waves, in short lines of the same length."""
    way = CHORD_MM * np.arange(rows) + 50
    turn = np.sqrt(4 * np.pi * way / PITCH_MM)
    x, y = PITCH_MM * turn / (2 * np.pi) * np.array([np.cos(turn), np.sin(turn)])
    return trajectory_of(np.column_stack([x, y, 80 + 2 * np.sin(x / 8) + 2 * np.cos(y / 7)]), feed=FEED)


def _report(follower, operator, results, machine=MACHINE):
    """Print what was measured, and compare it with the certificates."""
    print(f"{operator.host.clock.now() - operator.began:.0f} s by the clock of player and machine")
    print(f"{follower.samples} ms: tip {follower.tip:.6f} mm, axis {np.degrees(follower.axis):.6f} degrees")
    print(f"struts: {follower.speed:.1f} mm/s, {follower.acceleration:.0f} mm/s^2, {follower.jerk:.0f} mm/s^3")
    print(f"the operator: {dict(Counter(operator.done))}")
    for one in results:
        print(f"{one.log.seconds:.1f} s in {one.log.motions} pieces, rests {one.stops}, losses {one.losses}")
    grown = operator.memory[-1] - operator.memory[len(operator.memory) // 10]
    print(f"memory: {operator.memory[-1]:.0f} MiB, {grown:.0f} MiB more than after a tenth")
    assert grown < MOST_GROWTH_MIB
    operated.check(follower, results, machine)


if __name__ == "__main__":
    logging.disable(logging.CRITICAL)
    begin, spent = time.monotonic(), time.process_time()
    {"luck": luck, "links": links, "play": play, "long": long}[sys.argv[1]](*sys.argv[2:])
    spent, most = time.process_time() - spent, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{time.monotonic() - begin:.0f} s, {spent:.0f} s of the processor, at most {most:.0f} MiB")
