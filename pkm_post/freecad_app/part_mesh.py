# SPDX-License-Identifier: LGPL-2.1-or-later
"""Part mesh: the model of a CAM job as triangles, for checks of what must not touch it.

A job enters; corners of triangles leave, in mm, in the work frame {C} of the job.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pkm_post.geometry.vectors import Array

_DEVIATION = 0.1
"""mm that the triangles may be off the faces; clearances of spindles and holders are far above it."""


def part_mesh(job: Any) -> Array:
    """Triangles of all models of a job, (T, 3, 3)."""
    meshes = [_triangles(item.Shape) for item in job.Model.Group if hasattr(item, "Shape")]
    return np.concatenate([np.empty((0, 3, 3)), *meshes])


def _triangles(shape: Any) -> Array:
    points, corners = shape.tessellate(_DEVIATION)
    at = np.array([(point.x, point.y, point.z) for point in points]).reshape(-1, 3)
    return at[np.array(corners, dtype=np.int64).reshape(-1, 3)]
