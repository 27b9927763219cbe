# SPDX-License-Identifier: LGPL-2.1-or-later
"""Known set-up: the known part, stock and fixtures; files named by the user override those of the job."""

from __future__ import annotations

from dataclasses import replace

from pkm_post.model import Diagnostic, Mesh, Program, Setup
from pkm_post.options import NO_MESH, Options
from pkm_post.reading import read_mesh


def known_setup(options: Options, program: Program | None) -> tuple[Setup, tuple[Diagnostic, ...]]:
    """The set-up of a program, and diagnostics of its files.

    Args:
        options: the files, and the set-up of the job.
        program: knows the tools with unknown corners, which a trajectory file does not store; None if it has errors.
    """
    files, found = options.mesh_files, list[Diagnostic]()

    def read(file: str | None, otherwise: Mesh | None = None) -> Mesh | None:
        if file is None or file == NO_MESH:
            return otherwise if file is None else None
        mesh, faults = read_mesh(file)
        found.extend(faults)
        return mesh

    fixtures = tuple(mesh for mesh in map(read, files.fixtures) if mesh is not None)
    tools = program.tools.values() if program is not None else ()
    known = options.setup
    setup = replace(
        known,
        part=read(files.part, known.part),
        stock=read(files.stock, known.stock),
        fixtures=(*known.fixtures, *fixtures),
        unknown_corners=frozenset(tool.number for tool in tools if not tool.corner_known),
    )
    return setup, tuple(found)
