# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work offsets of a machine file: pose of {C} in {M} from an origin with a rotation about z, or from a matrix.

Input: the entries below ``work_offsets`` in mm and rad. Output: (4, 4) matrices by name, and the faults of offsets with
no pose or two.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from pkm_post.machine.description.faults import Fault
from pkm_post.machine.description.forms import Array

SECTION = "work_offsets"


def offset_names(document: dict[str, Any]) -> list[str]:
    """Names of the work offsets, in file order."""
    section = document.get(SECTION)
    return [name for name, offset in section.items() if isinstance(offset, dict)] if isinstance(section, dict) else []


def stated_poses(names: list[str], document: dict[str, Any]) -> list[Fault]:
    """Faults of offsets without exactly one of origin and matrix."""
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
    """Pose with this origin, rotated by ``rotation_z`` rad about the z axis of {M}."""
    cosine, sine = math.cos(rotation_z), math.sin(rotation_z)
    pose = np.eye(4)
    pose[:2, :2] = (cosine, -sine), (sine, cosine)
    pose[:3, 3] = origin
    return pose


def work_offsets(names: list[str], values: dict[str, Any]) -> dict[str, Array]:
    """Poses ``machine_from_work`` by name, of faultless offsets."""
    poses = {}
    for name in names:
        origin, rotation_z, matrix = (values[f"{SECTION}.{name}.{key}"] for key in ("origin", "rotation_z", "matrix"))
        poses[name] = _upright(origin, rotation_z) if matrix is None else matrix
        poses[name].flags.writeable = False
    return poses
