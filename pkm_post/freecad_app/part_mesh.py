# SPDX-License-Identifier: LGPL-2.1-or-later
"""Part mesh: a shape as triangles, for collision checks.

Takes a shape; returns corners of triangles, in mm, in the frame of the shape.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pkm_post.geometry import Array

_DEVIATION = 0.1
"""Largest deviation of the triangles from the faces, mm; clearances of spindles and holders are far larger."""


def mesh_of(shape: Any) -> Array:
    """Triangles of a shape, (T, 3, 3)."""
    points, corners = shape.tessellate(_DEVIATION)
    at = np.array([(point.x, point.y, point.z) for point in points]).reshape(-1, 3)
    return at[np.array(corners, dtype=np.int64).reshape(-1, 3)]
