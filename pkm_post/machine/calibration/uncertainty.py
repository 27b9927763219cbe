# SPDX-License-Identifier: LGPL-2.1-or-later
"""Uncertainty: errors of a calibrated machine, by repeating its calibration with simulated measurement noise.

Input: the calibrated machine, the poses it was measured at, and the noise of a measurement. Output: the spread of the
42 parameters, and the tip error of a controller that uses them. Each run takes the calibrated machine for the real one,
measures it again with new noise, and calibrates with that. The tip may be well known even where single parameters are
not, so judge by the tip. The runs are independent, each with its own random numbers: any executor of
``concurrent.futures`` can distribute them, with bit-identical results. [JCGM101, 7]
"""

from __future__ import annotations

import functools
import math
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, norm, unit
from pkm_post.machine.calibration.identification import PARAMETERS, Calibration, MeasuredPoses, calibrate
from pkm_post.machine.kinematics.forward import forward
from pkm_post.machine.kinematics.inverse import platform_rotation, strut_lengths
from pkm_post.model import Machine

_RUNS_PER_TASK = 16
_COVERED = 0.95
"""Share of the tips with less error than the reported distance."""


@dataclass(frozen=True)
class MeasurementNoise:
    """Standard deviations of a measurement.

    Attributes:
        tip: of each coordinate of a tool tip, mm.
        angle: of a tool axis about each axis across it, and of the spin, rad.
        length: of a counted strut length, mm.
    """

    tip: float
    angle: float
    length: float

    def __post_init__(self) -> None:
        if not all(0.0 <= value < math.inf for value in (self.tip, self.angle, self.length)):
            raise ValueError(f"expected standard deviations of 0 or above, got {self}")


def noise_of_residuals(found: Calibration) -> MeasurementNoise:
    """Noise of the lengths from their residuals, for exact poses; 0 if there are no residuals to spare."""
    spare = found.left_over.size - found.rank
    return MeasurementNoise(0.0, 0.0, math.sqrt(float((found.left_over**2).sum()) / spare) if spare > 0 else 0.0)


@dataclass(frozen=True)
class CalibrationUncertainty:
    """Result of R runs.

    Attributes:
        noise: of a measurement.
        runs: number of runs that converged.
        failed: number of runs that did not.
        deviation: (6, 7) standard deviations of the parameters, mm; for an undetermined combination
            only the part that varies. Infinite, like the distances, if fewer than 2 runs converged.
        tip_median: median tip error over all runs and poses, mm.
        tip_most: 95th percentile of the tip error, mm.
    """

    noise: MeasurementNoise
    runs: int
    failed: int
    deviation: Array
    tip_median: float
    tip_most: float


def calibration_uncertainty(
    found: Calibration,
    measured: MeasuredPoses,
    noise: MeasurementNoise,
    runs: int = 1000,
    executor: Executor | None = None,
) -> CalibrationUncertainty:
    """Repeat a calibration.

    Args:
        found: a calibration that converged.
        measured: the poses it was identified from; their lengths are not used.
        noise: of each measurement.
        runs: number of runs, at least 2.
        executor: distributes the runs; by default they run in this process.

    Raises:
        ValueError: there are fewer than 2 runs.
    """
    if runs < 2:
        raise ValueError(f"runs: expected 2 or more, got {runs}")
    real = found.machine
    exact = replace(measured, lengths=strut_lengths(real, *measured.pose))
    seeds = np.random.SeedSequence(1).spawn(runs)
    parts = [seeds[first : first + _RUNS_PER_TASK] for first in range(0, runs, _RUNS_PER_TASK)]
    task = functools.partial(_repeated, real, exact, noise)
    done = executor.map(task, parts) if executor else map(task, parts)
    parameters, distances = (np.concatenate(columns) for columns in zip(*done, strict=True))
    converged = ~np.isnan(distances).any(axis=1)
    count = int(converged.sum())
    spread, median, most = np.full((6, len(PARAMETERS)), np.inf), np.inf, np.inf
    if count > 1:
        spread = parameters[converged].std(axis=0, ddof=1)
        median, most = np.quantile(distances[converged], [0.5, _COVERED])
    return CalibrationUncertainty(noise, count, runs - count, spread, float(median), float(most))


def parameters_of(machine: Machine) -> Array:
    """The 42 parameters of a machine, (6, 7), in the order of ``PARAMETERS``, mm."""
    return np.hstack([machine.base_joints, machine.platform_joints, machine.length_offset[:, None]])


def _repeated(
    real: Machine, exact: MeasuredPoses, noise: MeasurementNoise, seeds: list[np.random.SeedSequence]
) -> tuple[Array, Array]:
    """Parameters (R, 6, 7) and distances of the tips (R, N) of some runs; NaN where a run did not converge."""
    parameters = np.full((len(seeds), 6, len(PARAMETERS)), np.nan)
    distances = np.full((len(seeds), len(exact)), np.nan)
    for run, seed in enumerate(seeds):
        again = calibrate(real, _with_noise(exact, noise, np.random.default_rng(seed)))
        if again.converged:
            parameters[run] = parameters_of(again.machine)
            distances[run] = tip_distances(again.machine, real, exact)
    return parameters, distances


def tip_distances(believed: Machine, real: Machine, poses: MeasuredPoses) -> Array:
    """Tip errors, (N,) mm, of a controller that assumes another machine; NaN where no pose is found."""
    sent = strut_lengths(believed, *poses.pose)
    reached = forward(real, sent, poses.tool_length, poses.tip, poses.axis, poses.spin)
    return np.where(reached.converged, norm(reached.tip - poses.tip), np.nan)


def _with_noise(exact: MeasuredPoses, noise: MeasurementNoise, random: np.random.Generator) -> MeasuredPoses:
    across = platform_rotation(exact.axis, exact.spin)[:, :, :2] @ random.normal(0.0, 1.0, (len(exact), 2, 1))
    return MeasuredPoses(
        tip=exact.tip + random.normal(0.0, 1.0, exact.tip.shape) * noise.tip,
        axis=unit(exact.axis + noise.angle * across[..., 0]),
        spin=exact.spin + random.normal(0.0, 1.0, exact.spin.shape) * noise.angle,
        tool_length=exact.tool_length,
        lengths=exact.lengths + random.normal(0.0, 1.0, exact.lengths.shape) * noise.length,
    )
