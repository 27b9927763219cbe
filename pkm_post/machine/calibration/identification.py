# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calibration: identify the true joint positions from measured poses and counted strut lengths.

A strut has seven parameters: base joint b, platform joint a, and length offset o. At a measured pose the controller
counts |p + R a - b| + screw - o. Its derivative by (b, a, o) is the row [-u, R^T u, -1], with u corrected for the
screw. Seven or more poses give the seven parameters of each strut by Gauss-Newton on all rows; 42 in all. The struts
share only the poses, so the problem separates into six systems of seven columns.

Poses that are too similar leave parameter combinations undetermined. Columns are scaled to one; combinations whose
singular value is below a share of the largest keep their values and are reported.
[Nategh and Agheli 2009]
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, norm, unit
from pkm_post.machine.kinematics.inverse import counted_lengths, platform_rotation, strut_vectors
from pkm_post.machine.kinematics.screw import screw_gradient
from pkm_post.model import Machine, freeze

PARAMETERS = ("base x", "base y", "base z", "platform x", "platform y", "platform z", "offset")
"""Parameters of one strut, in array order: base joint in {M}, platform joint in {T}, length offset; mm."""
_STEP_TOLERANCE = 1e-9
"""mm: Gauss-Newton stops when no parameter moves by more."""
_LEAST_SHARE = 1e-6
"""Smaller shares of a parameter in a combination are rounding errors."""


@dataclass(frozen=True)
class MeasuredPoses:
    """N measured poses with the strut lengths that the controller counted at them.

    Attributes:
        tip: (N, 3) tool tips in {M}, mm.
        axis: (N, 3) unit tool axes in {M}.
        spin: (N,) rad.
        tool_length: (N,) gauge lengths, mm.
        lengths: (N, 6) counted strut lengths, mm.
    """

    tip: Array
    axis: Array
    spin: Array
    tool_length: Array
    lengths: Array

    def __post_init__(self) -> None:
        shapes: dict[str, tuple[int, ...]] = {"tip": (3,), "axis": (3,), "spin": (), "tool_length": (), "lengths": (6,)}
        freeze(self, len(self.tip), {name: (np.float64, shape) for name, shape in shapes.items()})

    def __len__(self) -> int:
        return len(self.tip)

    @property
    def pose(self) -> tuple[Array, Array, Array, Array]:
        """The poses as arguments for ``inverse``."""
        return self.tip, self.axis, self.spin, self.tool_length


@dataclass(frozen=True)
class Calibration:
    """Result of a calibration.

    Attributes:
        machine: the machine with the identified joints and offsets.
        converged: whether the last step was below the tolerance; if not, the result is unusable.
        rank: number of parameter combinations that the poses determine, at most 42.
        condition: of the scaled rows: ratio of the worst to the best amplification of length errors, over the
            determined combinations.
        deviation: (6, 7) standard deviations of the parameters, mm, estimated from the length residuals; infinite for
            a parameter in an undetermined combination, and everywhere if there are no residuals to spare.
        undetermined: (strut, (7,) combination) of unit length for each one that the poses do not determine.
        before: root mean square of the length residuals before, mm.
        after: the same with the identified machine.
        left_over: (N, 6) counted lengths minus those of the identified machine, mm; a wrong measurement
            stands out here.
    """

    machine: Machine
    converged: bool
    rank: int
    condition: float
    deviation: Array
    undetermined: tuple[tuple[int, Array], ...]
    before: float
    after: float
    left_over: Array


def calibrate(
    machine: Machine, measured: MeasuredPoses, least_share: float = 1e-4, iterations: int = 50
) -> Calibration:
    """Identify the 42 parameters of a machine, or as many of them as the poses determine.

    Args:
        machine: the nominal machine; undetermined combinations keep its values.
        measured: poses and counted lengths.
        least_share: combinations with a singular value below this share of their strut's largest are kept. It should
            exceed the noise of measured orientations, in rad.
        iterations: maximum number of steps.

    Raises:
        ValueError: there are no poses.
    """
    if not len(measured):
        raise ValueError("expected measured poses, got none")
    found, converged = machine, False
    for _ in range(iterations):
        step = _pseudo_inverse(*_scaled(found, measured), least_share) @ _missing(found, measured).T[..., None]
        found = _moved(found, step[..., 0])
        converged = bool(np.abs(step).max() < _STEP_TOLERANCE)
        if converged:
            break
    return _judged(machine, found, converged, measured, least_share)


def identification_rows(machine: Machine, measured: MeasuredPoses) -> Array:
    """Derivatives of the counted lengths by the parameters of their struts, (6, N, 7), dimensionless."""
    struts = strut_vectors(machine, *measured.pose)
    distance = norm(struts)
    direction, rotation = struts / distance[..., None], platform_rotation(measured.axis, measured.spin)
    along = direction + screw_gradient(direction, distance, rotation, machine)[0]
    rows = np.concatenate([-along, along @ rotation, -np.ones((*distance.shape, 1))], axis=-1)
    return rows.transpose(1, 0, 2)


def combination_text(strut: int, combination: Array) -> str:
    """Format an undetermined combination: strut 1: 0.71 base x + 0.71 platform x."""
    shares = [(share, name) for share, name in zip(combination, PARAMETERS, strict=True) if abs(share) >= 5e-3]
    return f"strut {strut + 1}: " + " ".join(f"{share:+.2f} {name}" for share, name in shares)


def _missing(machine: Machine, measured: MeasuredPoses) -> Array:
    """Counted lengths minus those of the machine, (N, 6)."""
    struts = strut_vectors(machine, *measured.pose)
    distance, rotation = norm(struts), platform_rotation(measured.axis, measured.spin)
    return measured.lengths - counted_lengths(machine, distance, struts / distance[..., None], rotation)


def _moved(machine: Machine, step: Array) -> Machine:
    """The machine with the steps (6, 7) added to its parameters."""
    return replace(
        machine,
        base_joints=machine.base_joints + step[:, :3],
        platform_joints=machine.platform_joints + step[:, 3:6],
        length_offset=machine.length_offset + step[:, 6],
    )


def _scaled(machine: Machine, measured: MeasuredPoses) -> tuple[tuple[Array, Array, Array], Array]:
    """Singular value decompositions of the rows with unit columns, and the column lengths (6, 7)."""
    rows = identification_rows(machine, measured)
    scale = np.linalg.norm(rows, axis=1)
    scale[scale == 0.0] = 1.0
    # Zero rows, so that fewer poses than parameters have seven singular values as well
    rows = np.pad(rows / scale[:, None, :], ((0, 0), (0, max(0, len(PARAMETERS) - len(measured))), (0, 0)))
    left, values, right = np.linalg.svd(rows, full_matrices=False)
    return (left[:, : len(measured)], values, right), scale


def _determined(values: Array, least_share: float) -> Array:
    return np.asarray(values > least_share * values[:, :1])


def _pseudo_inverse(decomposed: tuple[Array, Array, Array], scale: Array, least_share: float) -> Array:
    """Map length differences to parameter steps, (6, 7, N)."""
    left, values, right = decomposed
    known = _determined(values, least_share)
    inverse = np.where(known, 1.0 / np.where(known, values, 1.0), 0.0)
    steps = (right.transpose(0, 2, 1) * inverse[:, None, :]) @ left.transpose(0, 2, 1) / scale[..., None]
    for strut in np.flatnonzero(~known.all(axis=1)):
        # Short scaled steps may be long in mm; the part along undetermined combinations changes no length.
        free, _ = np.linalg.qr((right[strut, ~known[strut]] / scale[strut]).T)
        steps[strut] -= free @ (free.T @ steps[strut])
    return steps


def _judged(
    machine: Machine, found: Machine, converged: bool, measured: MeasuredPoses, least_share: float
) -> Calibration:
    decomposed, scale = _scaled(found, measured)
    values, right = decomposed[1:]
    known = _determined(values, least_share)
    rank = int(known.sum())
    left_over = _missing(found, measured)
    spare = left_over.size - rank
    amplified = norm(_pseudo_inverse(decomposed, scale, least_share))
    deviation = amplified * np.sqrt((left_over**2).sum() / spare) if spare > 0 else np.full_like(amplified, np.inf)
    free = [(strut, unit(right[strut, row] / scale[strut])) for strut, row in np.argwhere(~known).tolist()]
    for strut, combination in free:
        deviation[strut, np.abs(combination) > _LEAST_SHARE] = np.inf
    return Calibration(
        machine=found,
        converged=converged,
        rank=rank,
        condition=float(values[known].max() / values[known].min()),
        deviation=deviation,
        undetermined=tuple(free),
        before=_root_mean_square(_missing(machine, measured)),
        after=_root_mean_square(left_over),
        left_over=left_over,
    )


def _root_mean_square(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
