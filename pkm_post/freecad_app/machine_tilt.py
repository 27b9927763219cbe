# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine tilt: largest tilt of the tool from upright that a machine reaches everywhere around a part.

Takes a machine, the pose of the part on it, the gauge length and a box around the faces; returns an angle in rad. Every
tilt direction is tried at the corners and the centre of the box; struts, joints and singular poses decide, as in the
later check of the whole path, which is the binding one.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.tools import read_tools
from pkm_post.geometry import Array
from pkm_post.machine import machine_named, reach_margins
from pkm_post.model import Diagnostic, Machine, Place
from pkm_post.posting import work_offset

_TILTS = np.radians(np.arange(0.0, 80.5, 0.5))
_DIRECTIONS = np.radians(np.arange(0.0, 360.0, 15.0))


def machine_tilt(
    name: str, job: Any, controller: Any, box: tuple[Array, Array], place: Place
) -> tuple[float | None, tuple[Diagnostic, ...]]:
    """The largest tilt from upright that the machine reaches at the part in every direction.

    Args:
        name: name of a machine included in PKM Post, or path of a machine file.
        job: the CAM job, with its work offset and its gauge lengths.
        controller: the tool controller, with a gauge length.
        box: lowest and highest corner of the region of the tip, (3,) each, mm.
        place: location stated in diagnostics.

    Returns:
        The angle in rad, or None; and the faults: M1xx of the machine file, J113, K108, N310.

    Raises:
        Refused: the arguments of the job are invalid, J117.
    """
    settings = settings_of(job)
    machine, machine_faults = machine_named(name)
    tools, tool_faults = read_tools([controller], settings.tool_lengths, place.file)
    if machine is None or not tools:
        return None, (*machine_faults, *tool_faults)
    offset, faults = work_offset(machine, settings.options)
    if offset is None:
        return None, faults
    tilt = _largest(machine, offset, tools[int(controller.ToolNumber)].length, *box)
    if tilt is None:
        return None, (Diagnostic("N310", place, f"{machine.name} at {settings.arguments.work_offset}"),)
    return tilt, ()


def _largest(machine: Machine, machine_from_work: Array, length: float, low: Array, high: Array) -> float | None:
    """The last tilt before the first that is out of reach somewhere; None if upright is out of reach."""
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
    points = np.vstack([(np.asarray(low) + high) / 2, corners])
    tilt, turn = (each.ravel() for each in np.meshgrid(_TILTS, _DIRECTIONS, indexing="ij"))
    lean = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    tip = np.tile(points @ machine_from_work[:3, :3].T + machine_from_work[:3, 3], (len(lean), 1))
    axis = np.repeat(lean @ machine_from_work[:3, :3].T, len(points), axis=0)
    margins = reach_margins(machine, tip, axis, np.zeros(len(tip)), np.full(len(tip), length))
    worst = np.minimum.reduce([
        *(each.min(axis=1) for each in (margins.shortest, margins.longest, margins.base, margins.platform)),
        margins.singular,
    ])  # fmt: skip
    reached = (worst.reshape(len(_TILTS), -1) >= 0.0).all(axis=1)
    beyond = int(np.argmin(reached)) if not reached.all() else len(_TILTS)
    return float(_TILTS[beyond - 1]) if beyond else None


def upright(cone_axis: Any) -> bool:
    """Whether the axis of a cone points straight up."""
    x, y, z = cone_axis
    return bool(z > 0.0 and math.hypot(x, y) <= 1e-9 * z)
