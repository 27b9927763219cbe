# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calibrated: write a machine file with identified joints and length offsets, and a report on them.

The new file is the old text with three entries replaced; it is parsed again before it is kept. Lengths in mm.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from pkm_post.machine.calibration.measurements import read_measurements
from pkm_post.machine.description import CannotRewriteError, find_machine, machine_named, machine_of, with_entries
from pkm_post.machine.kinematics.calibration import PARAMETERS, Calibration, calibrate, combination_text
from pkm_post.model import Diagnostic, Machine, Place, errors
from pkm_post.system import staged, write_fault

_WRITTEN = 1e-6
"""mm: largest change of a number by formatting."""


def calibrate_file(machine_file: str, measurements: Path, out: Path) -> tuple[str | None, tuple[Diagnostic, ...]]:
    """Calibrate a machine and write its new file.

    Args:
        machine_file: name of a preset or path of a machine file.
        measurements: CSV file of poses and lengths.
        out: the machine file to write.

    Returns:
        A report for the user, or None when nothing was written; and the diagnostics.
    """
    machine, faults = machine_named(machine_file)
    measured, wrong = read_measurements(measurements)
    path = find_machine(machine_file)
    if machine is None or measured is None or path is None:
        return None, faults + wrong
    found = calibrate(machine, measured)
    told = _told(found, str(measurements))
    if errors(told):
        return None, told
    text, faults = _text(path, found, len(measured), measurements.name, str(out))
    told += faults
    if text is None:
        return None, told
    try:
        with staged(out.parent) as folder:
            (folder / out.name).write_text(text, encoding="utf-8", newline="")
    except OSError as fault:
        return None, (*told, write_fault(out, fault))
    return report(machine, found, len(measured)), told


def report(machine: Machine, found: Calibration, poses: int) -> str:
    """Format the result, strut by strut: change of each parameter, and its standard deviation below."""
    change = _parameters(found.machine) - _parameters(machine)
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
    return "\n".join(rows)


def _told(found: Calibration, file: str) -> tuple[Diagnostic, ...]:
    if not found.converged:
        return (
            Diagnostic("M203", Place(file), f"lengths are off by {found.before:.4f} mm, then {found.after:.4f} mm"),
        )
    if found.undetermined:
        return (Diagnostic("M205", Place(file), f"rank {found.rank} of {found.deviation.size}"),)
    return ()


def _text(
    path: Path, found: Calibration, poses: int, source: str, out: str
) -> tuple[str | None, tuple[Diagnostic, ...]]:
    """Text of the new file, after parsing it again."""
    entries = {
        "base.joints": found.machine.base_joints,
        "platform.joints": found.machine.platform_joints,
        "struts.length_offset": found.machine.length_offset,
    }
    try:
        text = with_entries(path.read_bytes().decode("utf-8"), entries)
    except CannotRewriteError as fault:
        return None, (Diagnostic("M204", Place(str(path)), str(fault)),)
    text = (
        f"# Calibrated with {source}: {poses} poses, rank {found.rank} of {found.deviation.size}, lengths off by"
        f" {found.before:.4f} mm before and {found.after:.4f} mm after.\n{text}"
    )
    written, faults = machine_of(text.encode("utf-8"), out)
    if written is None:
        return None, faults
    if np.abs(_parameters(written) - _parameters(found.machine)).max() > _WRITTEN:
        return None, (Diagnostic("M204", Place(str(path)), "its entries were not found again"),)
    return text, ()


def _parameters(machine: Machine) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.hstack([machine.base_joints, machine.platform_joints, machine.length_offset[:, None]])
