# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player text: what the player says of an instant: time, block, the problem at which it stopped, struts too fast.

A simulation and a time in s enter; a line leaves, in the language of FreeCAD.
"""

from __future__ import annotations

import FreeCAD

from pkm_post.freecad_app.simulated_motion import Problem, Simulation

translate = FreeCAD.Qt.translate


def told(simulation: Simulation, seconds: float, problem: Problem | None, override: float) -> str:
    """The line.

    Args:
        simulation: what is played.
        seconds: the time that is shown.
        problem: at which the player has stopped, if it has.
        override: feed override as a share: 1 is as planned.
    """
    place = simulation.trajectory.place(simulation.block_at(seconds))
    block = translate("PKM_Simulate", "{}, line {}").format(place.operation, place.line)
    more = [problem.text] if problem else []
    return "   ".join([
        f"{seconds:.3f} s / {simulation.duration:.3f} s", block, *more, *_too_fast(simulation, override)
    ])  # fmt: skip


def _too_fast(simulation: Simulation, override: float) -> list[str]:
    """Which strut would be faster than it can be, with the override that is chosen."""
    limit, speeds = simulation.machine.strut_speed, simulation.greatest_speeds * override
    if override <= 1.0 or speeds.max() <= limit:
        return []
    text = translate("PKM_Simulate", "At this override strut {} would have to do {:.4g} of {:.4g} mm/s")
    return [text.format(int(speeds.argmax()) + 1, float(speeds.max()), limit)]
