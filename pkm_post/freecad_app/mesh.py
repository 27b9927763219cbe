# SPDX-License-Identifier: LGPL-2.1-or-later
"""Mesh: shapes and STEP files as triangles, for collision checks.

Triangles are in mm, whatever unit the file states; those of a shape in the frame of the shape, those of a file in the
work frame {C}.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import Part

from pkm_post.freecad_app.frames import rows_of
from pkm_post.geometry import Array
from pkm_post.model import Diagnostic, Phrase, Place
from pkm_post.reading import mesh_of_triangles
from pkm_post.system import read_fault

_DEVIATION = 0.1
"""Largest deviation of the triangles from the faces, mm; clearances of spindles and holders are far larger."""


def mesh_of(shape: Any) -> Array:
    """Triangles of a shape, (T, 3, 3)."""
    points, corners = shape.tessellate(_DEVIATION)
    return rows_of(points)[np.array(corners, dtype=np.int64).reshape(-1, 3)]


def read_step(path: Path, name: str) -> Any:
    """Read the solids of a STEP file as one mesh, by OpenCASCADE.

    Args:
        name: its name in diagnostics.

    Returns:
        The mesh, or None; and the faults: F103, K138.
    """
    shape = Part.Shape()
    try:
        path.open("rb").close()  # OpenCASCADE does not state why a file is unreadable
    except OSError as fault:
        return None, (read_fault(name, fault),)
    try:
        shape.read(str(path))
    except UnicodeEncodeError:
        return None, (Diagnostic("F103", Place(name), Phrase("FreeCAD reads only files with Unicode names")),)
    except (OSError, RuntimeError, Part.OCCError):
        return None, (Diagnostic("K138", Place(name), Phrase("OpenCASCADE cannot read it as STEP")),)
    return mesh_of_triangles(mesh_of(shape), name)
