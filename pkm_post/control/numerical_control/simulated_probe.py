# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulated probe: the input of a touch probe on a simulated controller, from its strut lengths.

Bodies are signed distances, mm, negative inside: a lower bound near their edges, exact near their faces.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pkm_post.control.link.status import MOTORS, AnySettings
from pkm_post.control.link.tool_pose import ToolPoseReadout
from pkm_post.control.simulator import Controller
from pkm_post.model import Array

Body = Callable[[Array], float]
"""Distance of a point (3,) in {M} from its surface."""


def plane(height: float) -> Body:
    """Everything below a z."""
    return lambda point: float(point[2]) - height


def boss(centre: tuple[float, float, float], diameter: float) -> Body:
    """An upright cylinder below the centre of its top."""
    return lambda point: max(_from_axis(point, centre) - diameter / 2, float(point[2]) - centre[2])


def bore(centre: tuple[float, float, float], diameter: float) -> Body:
    """A plate with an upright hole; the centre is at its top."""
    return lambda point: max(diameter / 2 - _from_axis(point, centre), float(point[2]) - centre[2])


_BODIES: dict[str, tuple[int, Callable[..., Body]]] = {
    "plane": (1, plane),
    "bore": (4, lambda x, y, z, diameter: bore((x, y, z), diameter)),
    "boss": (4, lambda x, y, z, diameter: boss((x, y, z), diameter)),
}


def body_of(text: str) -> Body:
    """Parse ``plane:Z``, ``bore:X,Y,Z,DIAMETER`` or ``boss:X,Y,Z,DIAMETER``, in {M} and mm.

    Raises:
        ValueError: the text has another form.
    """
    name, _, rest = text.partition(":")
    count, made = _BODIES.get(name, (0, plane))
    try:
        numbers = [float(word) for word in rest.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != count or not np.isfinite(numbers).all() or (count == 4 and numbers[3] <= 0):
        raise ValueError(f"expected plane:Z, bore:X,Y,Z,DIAMETER or boss:X,Y,Z,DIAMETER, got {text!r}")
    return made(*numbers)


def _from_axis(point: Array, centre: tuple[float, float, float]) -> float:
    return float(np.hypot(point[0] - centre[0], point[1] - centre[1]))


@dataclass(frozen=True)
class SimulatedProbe:
    """A probe without mass and pretravel.

    Attributes:
        controller: its motors carry the probe.
        readout: readout of the tip, the centre of the ball.
        ball: its diameter, mm.
    """

    controller: Controller
    settings: AnySettings
    readout: ToolPoseReadout
    ball: float
    body: Body

    def connect(self, variable: int) -> None:
        """Connect the state to an M-variable: 1 while the ball is in the body."""
        self.controller.inputs[variable] = self.value

    def value(self) -> float:
        """1 while the ball is in the body, else 0; 0 if the struts have no pose, as before homing."""
        counts = np.array([self.controller.motors.actual[motor - 1] for motor in MOTORS])
        length = counts / self.settings.counts_per_mm + np.array(self.settings.zero_length)
        pose = self.readout.pose_of(length)
        return float(pose is not None and self.body(pose.tip) < self.ball / 2)
