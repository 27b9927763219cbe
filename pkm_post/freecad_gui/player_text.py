# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player text: the player's status at an instant: time, block, the problem at which it stopped, struts too fast.

Takes a simulation and a time in s; returns a line in FreeCAD's language.
"""

from __future__ import annotations

import FreeCAD

from pkm_post.freecad_app.simulation import Problem, Simulation

translate = FreeCAD.Qt.translate


def told(simulation: Simulation, seconds: float, problem: Problem | None, override: float) -> str:
    """Return the status line.

    Args:
        simulation: the simulation being played.
        seconds: the current time.
        problem: the one at which the player has stopped, if any.
        override: feed override as a share: 1 is as planned.
    """
    place = simulation.trajectory.place(simulation.block_at(seconds))
    block = translate("PKM_Simulate", "{}, line {}").format(place.operation, place.line)
    more = [problem.text] if problem else []
    return "   ".join([
        f"{seconds:.3f} s / {simulation.duration:.3f} s", block, *more, *_too_fast(simulation, override)
    ])  # fmt: skip


def _too_fast(simulation: Simulation, override: float) -> list[str]:
    """The struts that would exceed their speed limit at the chosen override."""
    limit, speeds = simulation.machine.strut_speed, simulation.greatest_speeds * override
    if override <= 1.0 or speeds.max() <= limit:
        return []
    text = translate("PKM_Simulate", "At this override strut {} would have to do {:.4g} of {:.4g} mm/s")
    return [text.format(int(speeds.argmax()) + 1, float(speeds.max()), limit)]
