# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP files of part, stock and fixtures, as OpenCASCADE reads them: the same solids as in STL, the same findings."""

import os

import FreeCAD as App
import numpy as np
import Part
import pytest

from pkm_post.cli import main
from pkm_post.geometry.polygons import is_closed, volume
from pkm_post.reading.mesh_file import read_mesh

MICRON = 1e-3
WALL = Part.makeBox(80, 20, 105, App.Vector(-40, 30, 10))
"""15 mm into the holder, whose radius is 25 mm, of a tool that passes at y = 20."""
PASS = "G21 G90 G17\nT1 M6\nS5000 M3\nG0 X-30 Y20 Z60\nG0 Z12\nG1 Z10 F600\nG1 X30\nG0 Z60\nM5\nM2\n"


def stored(path, shape):
    (shape.exportStep if path.suffix.lower() in (".step", ".stp") else shape.exportStl)(str(path))
    return path


@pytest.mark.parametrize("name", ["wall.step", "wall.STP"])
def test_a_solid_lies_where_it_was(tmp_path, name):
    mesh, faults = read_mesh(stored(tmp_path / name, WALL))
    assert not faults and mesh.source == name and is_closed(mesh.triangles)
    assert volume(mesh.triangles) == pytest.approx(80.0 * 20.0 * 105.0)
    np.testing.assert_allclose(mesh.triangles.reshape(-1, 3).min(axis=0), [-40, 30, 10], atol=MICRON)


def test_several_round_solids_are_one_mesh(tmp_path):
    both = Part.makeCompound([Part.makeSphere(10), Part.makeCylinder(5, 20, App.Vector(50, 0, 0))])
    mesh, faults = read_mesh(stored(tmp_path / "both.step", both))
    exact = 4 / 3 * np.pi * 10**3 + np.pi * 5**2 * 20
    assert not faults and exact * 0.95 < volume(mesh.triangles) < exact


def test_inches_are_read_as_such(tmp_path):
    """The unit that the file states counts; ISO 10303-21 writes a conversion based unit of 25.4 mm."""
    settings = App.ParamGet("User parameter:BaseApp/Preferences/Mod/Part/STEP")
    general = App.ParamGet("User parameter:BaseApp/Preferences/Mod/Part/General")
    before = settings.GetInt("Unit", 0), general.GetInt("Unit", 0)
    try:
        settings.SetInt("Unit", 2)
        general.SetInt("Unit", 2)
        document = App.newDocument(hidden=True)
        item = document.addObject("Part::Feature", "Wall")
        item.Shape = WALL
        import Import

        Import.export([item], str(tmp_path / "inch.step"))
        App.closeDocument(document.Name)
    finally:
        settings.SetInt("Unit", before[0])
        general.SetInt("Unit", before[1])
    mesh, faults = read_mesh(tmp_path / "inch.step")
    assert not faults and volume(mesh.triangles) == pytest.approx(80.0 * 20.0 * 105.0)


@pytest.mark.parametrize("content", [b"", b"ISO-10303-21;\nHEADER;", b"solid x\nendsolid x\n"])
def test_what_is_no_step_file_is_refused(tmp_path, content):
    file = tmp_path / "bad.step"
    file.write_bytes(content)
    mesh, faults = read_mesh(file)
    assert mesh is None and [fault.code for fault in faults] == ["K138"]


def test_a_file_that_is_not_there(tmp_path):
    mesh, faults = read_mesh(tmp_path / "none.stp")
    assert mesh is None and [fault.code for fault in faults] == ["F103"]


def test_a_name_that_is_no_unicode(tmp_path):
    file = stored(tmp_path / "wall.step", WALL).rename(tmp_path / os.fsdecode(b"wall\xe9.step"))
    mesh, faults = read_mesh(file)
    assert mesh is None and [(fault.code, "Unicode" in fault.found) for fault in faults] == [("F103", True)]


def test_a_holder_in_the_part_is_refused_as_with_stl(tmp_path, capsys):
    program, said = tmp_path / "pass.ngc", []
    program.write_text(PASS, encoding="ascii")
    for name in ("wall.step", "wall.stl"):
        out = tmp_path / name.replace(".", "_")
        command = ["post", str(program), "--tool-length", "1=120", "--out", str(out)]
        assert main([*command, "--part", str(stored(tmp_path / name, WALL))]) == 1
        assert not out.exists() or not list(out.iterdir())
        said.append(capsys.readouterr().err.replace(name, "wall"))
    assert "K117" in said[0] and said[0] == said[1]
