# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measurements: read a CSV file of poses and strut lengths into ``kinematics.calibration.Measured``, or its faults.

One row per pose, in mm and degrees: tip x, y, z and tool axis i, j, k in {M}, spin, gauge length, and the six counted
strut lengths l1 to l6. docs/machine-file.md describes it.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from pkm_post.geometry import norm
from pkm_post.machine.kinematics.calibration import Measured
from pkm_post.model import Diagnostic, Place

COLUMNS = ("x", "y", "z", "i", "j", "k", "spin", "gauge", "l1", "l2", "l3", "l4", "l5", "l6")
_AXIS_TOLERANCE = 1e-3
"""Tolerance of the length of a tool axis: four decimals are common."""
_LEAST_K = -0.99
_LARGEST = 1e6


def read_measurements(path: Path) -> tuple[Measured | None, tuple[Diagnostic, ...]]:
    """Read a file of measurements.

    Args:
        path: CSV in UTF-8; empty lines and lines that begin with # are skipped.

    Returns:
        The measurements, or None and every fault of the file.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as fault:
        return None, (Diagnostic("M201", Place(str(path)), getattr(fault, "strerror", None) or str(fault)),)
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
    """Fault of a row, empty when it has none."""
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


def _measured(numbers: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Measured:
    axis = numbers[:, 3:6]
    return Measured(
        tip=numbers[:, :3],
        axis=axis / norm(axis)[:, None],
        spin=np.radians(numbers[:, 6]),
        tool_length=numbers[:, 7],
        lengths=numbers[:, 8:],
    )
