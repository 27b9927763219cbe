# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calibrate a file: write a machine file with identified joints and length offsets, and a report on them.

The new file is the old text with three entries replaced, and the path of a tool table where the folder is another; it
is parsed again before it is written. Lengths in mm.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine.calibration.identification import (
    PARAMETERS,
    Calibration,
    MeasuredPoses,
    calibrate,
    combination_text,
)
from pkm_post.machine.calibration.uncertainty import (
    CalibrationUncertainty,
    MeasurementNoise,
    calibration_uncertainty,
    noise_of_residuals,
    parameters_of,
)
from pkm_post.machine.description.presets import find_machine, machine_named
from pkm_post.machine.description.reader import machine_of
from pkm_post.machine.description.rewrite import CannotRewriteError, with_entries
from pkm_post.model import Diagnostic, Diagnostics, Machine, Place, errors
from pkm_post.system import reason_of, require_other, staged, write_fault

COLUMNS = ("x", "y", "z", "i", "j", "k", "spin", "gauge", "l1", "l2", "l3", "l4", "l5", "l6")
_AXIS_TOLERANCE = 1e-3
"""Tolerance of the length of a tool axis: four decimals are common."""
_LEAST_K = -0.99
_LARGEST = 1e6


def read_measurements(path: Path) -> tuple[MeasuredPoses | None, Diagnostics]:
    """Read a file of measurements.

    Args:
        path: CSV in UTF-8; empty lines and lines that begin with # are skipped.

    Returns:
        The measurements, or None and every fault of the file.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as fault:
        return None, (Diagnostic("M201", Place(str(path)), reason_of(fault, path)),)
    try:
        rows = list(_rows(text))
    except csv.Error as fault:
        return None, (Diagnostic("M202", Place(str(path)), str(fault)),)
    if not rows:
        return None, (Diagnostic("M202", Place(str(path)), f"expected a line {','.join(COLUMNS)} and rows below it"),)
    (line, head), *rows = rows
    if head != list(COLUMNS):
        found = f"expected the columns {','.join(COLUMNS)}, got {','.join(head)}"
        return None, (Diagnostic("M202", Place(str(path), line=line), found),)
    faults = tuple(
        Diagnostic("M202", Place(str(path), line=line), found) for line, cells in rows if (found := _fault(cells))
    )
    if faults or not rows:
        return None, faults or (Diagnostic("M202", Place(str(path), line=line), "no pose is below the columns"),)
    return _measured(np.array([cells for _, cells in rows], dtype=np.float64)), ()


def _rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the non-empty, non-comment lines with their numbers from 1."""
    # Line by line, since an unpaired quotation mark would swallow the lines below it.
    for line, row in enumerate(text.splitlines(), start=1):
        cells = [cell.strip() for cell in next(csv.reader([row]), [])]
        if any(cells) and not cells[0].startswith("#"):
            yield line, cells


def _fault(cells: list[str]) -> str:
    """Fault of a row; empty if none."""
    if len(cells) != len(COLUMNS):
        return f"expected {len(COLUMNS)} numbers, got {len(cells)}"
    numbers = np.array([_number(cell) for cell in cells])
    for name, cell, number in zip(COLUMNS, cells, numbers, strict=True):
        if not abs(number) < _LARGEST:
            return f"{name}: expected a number, got {cell!r}"
    named = dict(zip(COLUMNS, numbers, strict=True))
    length = float(norm(numbers[3:6]))
    if abs(length - 1.0) > _AXIS_TOLERANCE:
        return f"i, j, k: expected a vector of length 1, got {length:.4f}"
    if named["k"] < _LEAST_K:
        return "k: expected a tool axis that points from the tip to the spindle, got one that points down"
    short = [name for name in COLUMNS[8:] if named[name] <= 0.0]
    return f"{short[0]}: expected a length above 0, got {named[short[0]]:g}" if short else ""


def _number(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return float("nan")


def _measured(numbers: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> MeasuredPoses:
    axis = numbers[:, 3:6]
    return MeasuredPoses(
        tip=numbers[:, :3],
        axis=axis / norm(axis)[:, None],
        spin=np.radians(numbers[:, 6]),
        tool_length=numbers[:, 7],
        lengths=numbers[:, 8:],
    )


_WRITTEN = 1e-6
"""mm: largest change of a number by formatting."""


@dataclass(frozen=True)
class Repetition:
    """Repeat a calibration with noise, to estimate the error of the result.

    Attributes:
        runs: number of runs, at least 2.
        noise: of a measurement; None for noise of the lengths only, from their residuals.
        executor: distributes the runs; by default they run in this process.
    """

    runs: int
    noise: MeasurementNoise | None = None
    executor: Executor | None = None

    def of(self, found: Calibration, measured: MeasuredPoses) -> CalibrationUncertainty:
        """The uncertainty of a calibration."""
        noise = self.noise or noise_of_residuals(found)
        return calibration_uncertainty(found, measured, noise, self.runs, executor=self.executor)


def calibrate_file(
    machine_file: str, measurements: Path, out: Path, repetition: Repetition | None = None
) -> tuple[str | None, Diagnostics]:
    """Calibrate a machine and write its new file.

    Args:
        machine_file: name of a preset or path of a machine file.
        measurements: CSV file of poses and lengths.
        out: the machine file to write.
        repetition: for the uncertainty in the report.

    Returns:
        A report for the user, or None when nothing was written; and the diagnostics.
    """
    machine, faults = machine_named(machine_file)
    measured, wrong = read_measurements(measurements)
    path = find_machine(machine_file)
    if machine is None or measured is None or path is None:
        return None, faults + wrong
    found = calibrate(machine, measured)
    diagnostics = _diagnostics(found, str(measurements))
    if errors(diagnostics):
        return None, diagnostics
    text, faults = _calibrated_text(path, found, len(measured), measurements.name, out)
    diagnostics += faults
    if text is None:
        return None, diagnostics
    uncertainty = repetition.of(found, measured) if repetition else None
    try:
        require_other(out, [path, measurements])
        with staged(out.parent) as folder:
            (folder / out.name).write_text(text, encoding="utf-8", newline="")
    except OSError as fault:
        return None, (*diagnostics, write_fault(out, fault))
    return report(machine, found, len(measured), uncertainty), diagnostics


def report(machine: Machine, found: Calibration, poses: int, uncertainty: CalibrationUncertainty | None = None) -> str:
    """Format the result, strut by strut: change of each parameter, and its standard deviation below."""
    change = parameters_of(found.machine) - parameters_of(machine)
    worst, worst_strut = np.unravel_index(np.abs(found.left_over).argmax(), found.left_over.shape)
    rows = [
        f"poses {poses}, rank {found.rank} of 42, condition {found.condition:.4g}",
        f"lengths off by {found.before:.4f} mm before, {found.after:.4f} mm after (root mean square)",
        f"worst after: {found.left_over[worst, worst_strut]:.4f} mm, strut {worst_strut + 1} at pose {worst + 1}",
        "change and standard deviation in mm:",
        " ".join([" " * 7, *(f"{name:>10}" for name in PARAMETERS)]),
    ]
    for strut in range(len(change)):
        rows.append(" ".join([f"strut {strut + 1}", *(f"{value:10.4f}" for value in change[strut])]))
        rows.append(" ".join([" " * 7, *(f"{value:10.4f}" for value in found.deviation[strut])]))
    rows += [f"not determined: {combination_text(strut, shares)}" for strut, shares in found.undetermined]
    return "\n".join([*rows, *(_uncertainty_rows(uncertainty) if uncertainty else [])])


def _uncertainty_rows(uncertainty: CalibrationUncertainty) -> list[str]:
    noise, spread, half, most = uncertainty.noise, uncertainty.deviation, uncertainty.tip_median, uncertainty.tip_most
    strut, number = np.unravel_index(spread.argmax(), spread.shape)
    tip_axis_and_length = f"{noise.tip:.4g} mm, {np.degrees(noise.angle):.4g} deg and {noise.length:.4g} mm"
    rows = [
        f"{uncertainty.runs} calibrations again, with noise of {tip_axis_and_length} in tip, axis and length:",
        f"tool tip off by {half:.4f} mm in half of the poses, by less than {most:.4f} mm in 95 of 100",
        f"largest standard deviation {spread.max():.4f} mm: {PARAMETERS[number]} of strut {strut + 1}",
    ]
    return rows + ([f"{uncertainty.failed} more did not converge"] if uncertainty.failed else [])


def _diagnostics(found: Calibration, file: str) -> Diagnostics:
    if not found.converged:
        return (
            Diagnostic("M203", Place(file), f"lengths are off by {found.before:.4f} mm, then {found.after:.4f} mm"),
        )
    if found.undetermined:
        return (Diagnostic("M205", Place(file), f"rank {found.rank} of {found.deviation.size}"),)
    return ()


def _calibrated_text(
    path: Path, found: Calibration, poses: int, source: str, out: Path
) -> tuple[str | None, Diagnostics]:
    """Text of the new file, after parsing it again."""
    entries: dict[str, Array | str] = {
        "base.joints": found.machine.base_joints,
        "platform.joints": found.machine.platform_joints,
        "struts.length_offset": found.machine.length_offset,
    }
    if found.machine.tool_table is not None and out.parent.resolve() != path.parent.resolve():
        entries["part_programs.tool_table"] = str(Path(found.machine.tool_table).resolve())
    try:
        text = with_entries(path.read_bytes().decode("utf-8-sig"), entries)
    except CannotRewriteError as fault:
        return None, (Diagnostic("M204", Place(str(path)), str(fault)),)
    text = (
        f"# Calibrated with {source}: {poses} poses, rank {found.rank} of {found.deviation.size}, lengths off by"
        f" {found.before:.4f} mm before and {found.after:.4f} mm after.\n{text}"
    )
    written, faults = machine_of(text.encode("utf-8"), str(out))
    if written is None:
        return None, faults
    if np.abs(parameters_of(written) - parameters_of(found.machine)).max() > _WRITTEN:
        return None, (Diagnostic("M204", Place(str(path)), "its entries were not found again"),)
    return text, ()
