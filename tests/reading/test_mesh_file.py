# SPDX-License-Identifier: LGPL-2.1-or-later
"""STL files: both forms give the same mesh; what is damaged is refused at its line, and nothing is guessed."""

import numpy as np
import pytest
from meshes import ascii_stl, ball, binary_stl, box

from pkm_post.reading.mesh_file import decode, read_mesh

MESH = np.concatenate([box([-10.5, 0, 2], [3, 4, 5]), ball([20, 0, 0], 3.0, 6)])
SINGLE = 2.0**-23
"""Relative spacing of the 32-bit numbers of the binary form."""


def test_both_forms_are_read(tmp_path):
    (tmp_path / "b.stl").write_bytes(binary_stl(MESH))
    (tmp_path / "a.STL").write_bytes(ascii_stl(MESH))
    for name, tolerance in (("b.stl", SINGLE), ("a.STL", 0.0)):
        mesh, faults = read_mesh(tmp_path / name)
        assert not faults and mesh.source == name
        np.testing.assert_allclose(mesh.triangles, MESH, rtol=tolerance, atol=0)


def test_several_solids_and_odd_layout_are_one_mesh():
    text = ascii_stl(MESH[:2]) + b"\r\n" + ascii_stl(MESH[2:5]).upper().replace(b"\n", b"\r\n  ")
    mesh, faults = decode(text, "x.stl")
    assert not faults
    np.testing.assert_allclose(mesh.triangles, MESH[:5])


LINES = ascii_stl(MESH[:3]).split(b"\n")


@pytest.mark.parametrize(
    ("content", "line", "found"),
    [
        (b"", 0, "0 bytes are not an STL file"),
        (b"PK\3\4" + b"x" * 200, 0, "the file has 204"),
        (binary_stl(MESH)[:-1], 0, "the file has"),
        (binary_stl(MESH) + b"x", 0, "the file has"),
        (binary_stl(MESH[:0]), 0, "no triangles"),
        (b"solid nothing\nendsolid nothing\n", 0, "no triangles"),
        (b"\n".join([*LINES[:3], b"    vertex 1 2 x3", *LINES[4:]]), 4, "expected a number, got 'x3'"),
        (b"\n".join([*LINES[:3], b"    vertex 1 2", *LINES[4:]]), 5, "got 'vertex'"),
        (b"\n".join([*LINES[:6], b"endloop x", *LINES[7:]]), 7, "expected endfacet, got 'x'"),
        (b"\n".join(LINES[:12]), 12, "expected a whole facet"),
        (b"\n".join([*LINES[:3], b"    vertex 1 2 nan", *LINES[4:]]), 0, "triangle 1 has an implausible coordinate"),
        (binary_stl(np.where(np.arange(3) == 1, np.inf, MESH)), 0, "triangle 1 has an implausible coordinate"),
        (binary_stl(MESH * 1e6), 0, "an implausible coordinate"),
    ],
)  # fmt: skip
def test_damaged_files_are_refused(content, line, found):
    mesh, (fault,) = decode(content, "x.stl")
    assert mesh is None
    assert (fault.code, fault.place.line) == ("K138", line), str(fault)
    assert found in fault.found


def test_other_kinds_of_files_are_refused_by_name_and_missing_ones_reported(tmp_path):
    for name, code in (("part.obj", "K138"), ("part", "K138"), ("none.stl", "F103")):
        mesh, (fault,) = read_mesh(tmp_path / name)
        assert mesh is None and fault.code == code and name in fault.place.file
