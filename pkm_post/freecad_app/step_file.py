# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP file: reads a solid from a STEP file as a mesh, by OpenCASCADE; ``mesh_file`` uses it where FreeCAD runs.

Takes the path of a file; returns its triangles, in mm whatever unit the file states, in the work frame {C}.
"""

from __future__ import annotations

from pathlib import Path
from types import ModuleType
from typing import Any

from pkm_post.freecad_app.import_hook import when_imported


def install() -> None:
    """Let ``pkm_post.reading.mesh_file`` read STEP as soon as it is imported."""
    when_imported("pkm_post.reading.mesh_file", _register)


def _register(mesh_file: ModuleType) -> None:
    mesh_file.READERS.update(dict.fromkeys(mesh_file.STEP_SUFFIXES, read_step))


def read_step(path: Path, name: str) -> Any:
    """The solids of a STEP file as one mesh, as ``mesh_file.read_mesh``."""
    import Part

    from pkm_post.freecad_app.part_mesh import mesh_of
    from pkm_post.model import Diagnostic, Place
    from pkm_post.reading import mesh_of_triangles

    shape = Part.Shape()
    try:
        path.open("rb").close()  # OpenCASCADE does not state why a file is unreadable
    except OSError as fault:
        return None, (Diagnostic("F103", Place(name), str(fault)),)
    try:
        shape.read(str(path))
    except UnicodeEncodeError:
        return None, (Diagnostic("F103", Place(name), "FreeCAD reads files alone whose names are Unicode"),)
    except (OSError, RuntimeError, Part.OCCError):
        return None, (Diagnostic("K138", Place(name), "OpenCASCADE cannot read it as STEP"),)
    return mesh_of_triangles(mesh_of(shape), name)
