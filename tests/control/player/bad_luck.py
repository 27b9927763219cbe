# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plays with bad luck, drawn by a seed: late answers, noise, a dead link, late plans, and an operator meanwhile.

Whatever happens, the tool stays on the path within the tolerances, the struts keep their limits, in every other round
of faults those of jerk too, and no move ends at speed; at the end the machine has arrived, or rests on the path and the
player says why. Only the simulator's clock passes.
"""

import random

from playing import HOOK, JERK, JUMPING, SMOOTH, Playing, trajectory_of
from rig import Noise, carried

from pkm_post.control.link.errors import PmacError
from pkm_post.control.player.orders import Order

FAULTS = ("delays", "noise", "cut", "cut for good", "late plans", "all at once")
ARRIVED_MM = 1e-3
NOISE_PER_BYTE = 2e-5
LATEST_ANSWER_S, LATEST_PLAN_S = 0.4, 3.0
STATES = 160
"""States of the player among which the operator does something."""


def by_chance(seed):
    """Play once; the fault, and how it ended."""
    chance = random.Random(seed)
    fault = FAULTS[seed % len(FAULTS)]
    every = fault == "all at once"
    kind = "serial" if fault == "noise" or every else chance.choice(["serial", "tcp"])
    noise = Noise(seed, NOISE_PER_BYTE) if fault == "noise" or every else carried
    cut = chance.randrange(15_000, 40_000) if every or "cut" in fault else None
    playing = Playing.of(
        trajectory_of(HOOK), orders(chance), kind=kind, fault=noise, cut_at=cut, mends=fault != "cut for good"
    )
    if fault == "delays" or every:
        playing.wire.delay = lambda: chance.choice([0.0] * 9 + [chance.uniform(0, LATEST_ANSWER_S)])
    late = (lambda: chance.choice([0.0, 0.0, chance.uniform(0, LATEST_PLAN_S)])) if "late" in fault or every else None
    is_smooth = seed // len(FAULTS) % 2
    playing.machine = SMOOTH if is_smooth else JUMPING
    try:
        done = playing.play(delay=late, patience_s=2.0)
        end = "played to its end" if done.finished else "ended by the operator"
        assert done.log.holds
    except PmacError as error:
        end = type(error).__name__
        done = None
    playing.rest()
    playing.check()
    assert not is_smooth or playing.mean_jerk() <= JERK
    if done is not None and done.finished:
        assert playing.arrived() < ARRIVED_MM
    assert not playing.wire.controller.runs_program() or end != "played to its end"
    return fault, end


def orders(chance):
    """What an operator does, by the number of the state; each hold is followed by a resume."""
    found = {}
    for _ in range(chance.randrange(4)):
        state = chance.randrange(4, STATES)
        kind = chance.choice(["hold", "override", "override", "single"])
        if kind == "hold":
            found[state], found[state + 2] = [Order("hold")], [Order("resume")]
        elif kind == "override":
            found[state] = [Order("override", chance.choice([0.0, 0.1, 0.6, 1.5]))]
            found[state + 10] = [Order("override", 1.0)]
        else:
            found[state], found[state + 5] = [Order("single", 1.0)], [Order("single", 0.0)]
    return found
