# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work offsets of a machine file: an origin with a turn about z, or a whole matrix, becomes the pose of {C} in {M}.

Enters: the entries below ``work_offsets`` in mm and rad. Leaves: (4, 4) matrices by name, and the faults of offsets
that state no pose or two.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from pkm_post.machine_file.faults import Fault
from pkm_post.machine_file.forms import Array

SECTION = "work_offsets"


def offset_names(document: dict[str, Any]) -> list[str]:
    """The names the file gives to its offsets, in the order of the file."""
    section = document.get(SECTION)
    return [name for name, offset in section.items() if isinstance(offset, dict)] if isinstance(section, dict) else []


def stated_poses(names: list[str], document: dict[str, Any]) -> list[Fault]:
    """The faults of offsets that have not exactly one of origin and matrix."""
    faults = []
    for name in names:
        stated = document[SECTION][name]
        if "origin" not in stated and "matrix" not in stated:
            faults.append(Fault("M103", (SECTION, name, "origin"), "needed, unless there is a matrix"))
        faults += [
            Fault("M104", (SECTION, name, key), "expected either a matrix or an origin, got both")
            for key in ("origin", "rotation_z")
            if "matrix" in stated and key in stated
        ]
    return faults


def _upright(origin: Array, rotation_z: float) -> Array:
    """The pose with this origin, turned by ``rotation_z`` rad about the z axis of {M}."""
    cosine, sine = math.cos(rotation_z), math.sin(rotation_z)
    pose = np.eye(4)
    pose[:2, :2] = (cosine, -sine), (sine, cosine)
    pose[:3, 3] = origin
    return pose


def work_offsets(names: list[str], values: dict[str, Any]) -> dict[str, Array]:
    """The poses ``machine_from_work`` by name, of offsets that were found to be without fault."""
    poses = {}
    for name in names:
        origin, rotation_z, matrix = (values[f"{SECTION}.{name}.{key}"] for key in ("origin", "rotation_z", "matrix"))
        poses[name] = _upright(origin, rotation_z) if matrix is None else matrix
        poses[name].flags.writeable = False
    return poses
