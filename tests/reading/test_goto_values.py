# SPDX-License-Identifier: LGPL-2.1-or-later
"""GOTO statements with surface normals: read as the option says, and compensated by them."""

import argparse
from dataclasses import replace

import numpy as np
import pytest

from pkm_post.geometry import unit
from pkm_post.model import Tool
from pkm_post.model.diagnostics import errors
from pkm_post.options.converters import goto_values
from pkm_post.reading.part_program import ReadingOptions, read_content
from pkm_post.toolpath import Cutter, OffsetOptions, compensate, tip_from_contact
from pkm_post.writing.gcode import GcodeDialect, write

CL_DATA = b"UNITS/MM\nFEDRAT/60\nCUTTER/10,5\nLOADTL/1,LENGTH,60\nGOTO/0,0,9\nGOTO/1,2,3,0,0,1,.6,0,.8\nFINI\n"
NAMES = ("x", "y", "z", "i", "j", "k", "nx", "ny", "nz")


def test_normals_follow_the_axis_as_the_option_says():
    program, diagnostics = read_content(CL_DATA, "a.apt", ReadingOptions())
    assert (program, [fault.code for fault in errors(diagnostics)]) == (None, ["L402"])
    assert "--goto-values" in str(errors(diagnostics)[0])
    program, _ = read_content(CL_DATA, "a.apt", ReadingOptions(goto_values=NAMES))
    assert program.position[1].tolist() == [1, 2, 3]
    assert program.normal[1] == pytest.approx([0.6, 0, 0.8])
    assert np.isnan(program.normal[0]).all()


@pytest.mark.parametrize("text", ["x,y", "x,y,z,i", "i,j,k", "x,y,z,x,y,z", "x,y,z,w", "", "x,y,z,nx,ny"])
def test_names_are_of_whole_vectors(text):
    with pytest.raises(argparse.ArgumentTypeError, match="expected x,y,z"):
        goto_values(text)


@pytest.mark.parametrize("text", ["x,y,z", "i,j,k,x,y,z", "x,y,z,i,j,k,px,py,pz,nx,ny,nz", "x,i,y,j,z,k"])
def test_any_order_of_whole_vectors(text):
    assert goto_values(text) == tuple(text.split(","))


BULL_NOSE = Cutter.of(Tool(1, "", 20.0, 4.0, 60.0))
CONTACTS = ("px", "py", "pz", "nx", "ny", "nz", "i", "j", "k")


def contact_program(points, normals, axes, before="", after="", cutter="CUTTER/20,4", **options):
    """A file of contact points as the option reads it."""
    rows = [",".join(f"{value:.17g}" for value in row) for row in np.hstack([points, normals, axes])]
    text = f"UNITS/MM\nFEDRAT/60\n{cutter}\nLOADTL/1,LENGTH,60\n{before}" + "".join(f"GOTO/{row}\n" for row in rows)
    reading = ReadingOptions(goto_values=CONTACTS, **options)
    found, diagnostics = read_content(f"{text}{after}FINI\n".encode(), "a.apt", reading)
    assert found is not None, diagnostics
    return found


def dome(count):
    """Points of a sphere of 50 mm with their normals, and axes that lean elsewhere."""
    angle = np.linspace(0.3, 0.9, count)
    normals = np.column_stack([np.sin(angle), np.zeros(count), np.cos(angle)])
    axes = unit(normals + np.column_stack([np.zeros(count), np.full(count, 0.3), np.full(count, 0.5)]))
    return 50 * normals, normals, axes


def test_contact_points_become_tips_by_the_cutter_of_the_file():
    points, normals, axes = dome(9)
    found = contact_program(points, normals, axes)
    assert found.contact.all() and found.position == pytest.approx(points)
    assert found.reading[-1] == "9 points are contact points, as the option says"
    tips, faults = compensate(found, OffsetOptions(), {})
    expected, _ = tip_from_contact(points, normals, axes, BULL_NOSE)
    assert (faults, tips.contact.any()) == ((), False)
    assert tips.position == pytest.approx(expected)
    # by hand: the corner circle of 4 mm touches at the point, 6 mm from the axis
    for tip, point, normal, axis in zip(tips.position, points, normals, axes, strict=True):
        centre = point + 4 * normal
        from_tip = centre - tip
        assert from_tip @ axis == pytest.approx(4)
        assert np.linalg.norm(from_tip - 4 * axis) == pytest.approx(6)


def test_the_cutter_in_the_spindle_goes_before_that_of_the_file():
    points, normals, axes = dome(5)
    ball = Tool(1, "", 10.0, 5.0, 60.0)
    tips, _ = compensate(contact_program(points, normals, axes), OffsetOptions(), {1: ball})
    assert tips.position == pytest.approx(points + 5 * normals - 5 * axes)
    assert tips.tools[1].diameter == 10


def test_points_with_a_tip_stay_where_they_are():
    points, normals, axes = dome(4)
    found = contact_program(points, normals, axes, before="GOTO/0,0,99\n", after="GOTO/0,0,98,0,0,1\n")
    tips, _ = compensate(found, OffsetOptions(), {})
    assert tips.position[[0, -1]].tolist() == [[0, 0, 99], [0, 0, 98]]


@pytest.mark.parametrize(("cutter", "code"), [("CUTTER/20", "N117"), ("CUTTER/0,0", "N109")])
def test_contact_points_need_the_whole_cutter(cutter, code):
    found = contact_program(*dome(4), cutter=cutter)
    moved, faults = compensate(found, OffsetOptions(), {})
    assert (moved, [fault.code for fault in faults]) == (None, [code])


def test_contact_points_are_not_written_as_tips():
    text, faults = write(contact_program(*dome(3)), GcodeDialect.VECTOR)
    assert (text, [fault.code for fault in faults]) == (None, ["N119"])


def test_goto_values_without_a_position_are_refused():
    for text in ("px,py,pz", "px,py,pz,i,j,k", "nx,ny,nz,i,j,k"):
        with pytest.raises(argparse.ArgumentTypeError, match="px,py,pz and nx,ny,nz"):
            goto_values(text)
    assert goto_values(",".join(CONTACTS)) == CONTACTS


CONTACT = "GOTO/0,0,0,.6,0,.8,0,0,1\n"


@pytest.mark.parametrize(
    ("statements", "found"),
    [
        (f"{CONTACT}GODLTA/0,0,9\n", ("L417", 7, "GODLTA after a contact point")),
        (f"CYCLE/DRILL,DEPTH,5,CLEAR,2,MMPM,60\n{CONTACT}", ("L412", 7, "a hole at a contact point")),
        (f"FEDRAT/INVERS,5\nRAPID\n{CONTACT}GOTO/0,0,9\n", ("L416", 9, "a move to or from a contact point")),
        (f"CUTCOM/LEFT\n{CONTACT}{CONTACT}", ("L401", 7, "a contact point under CUTCOM, and 1 more")),
        (
            f"{CONTACT}CUTTER/10,1\n{CONTACT}",
            ("L401", 6, "contact points with several cutters of tool 1: 10,1, 20,4 mm"),
        ),
    ],
)
def test_contact_points_are_refused_where_the_tip_would_be_another(statements, found):
    text = f"UNITS/MM\nFEDRAT/60\nCUTTER/20,4\nLOADTL/1,LENGTH,60\nGOTO/0,0,50\n{statements}FINI\n"
    options = ReadingOptions(goto_values=CONTACTS, contour_data="contour", wear={}, cl_dialect="apt")
    program, diagnostics = read_content(text.encode(), "a.apt", options)
    (fault,) = errors(diagnostics)
    assert (program, fault.code, fault.place.line, str(fault.found)) == (None, *found)


def test_contact_points_become_the_tips_of_the_tool_in_use():
    head = (
        f"UNITS/MM\nFEDRAT/60\nCUTTER/20,4\nLOADTL/2,LENGTH,60\nGOTO/0,0,50\n{CONTACT}LOADTL/1,LENGTH,60\nCUTTER/8,1\n"
    )
    program, _ = read_content(f"{head}{CONTACT}FINI\n".encode(), "a.apt", ReadingOptions(goto_values=CONTACTS))
    tips, _ = compensate(program, OffsetOptions(), {})
    assert tips.position[1:] == pytest.approx(np.array([[6 + 4 * 0.6, 0, -4 * 0.2], [3 + 0.6, 0, -0.2]]))


def test_the_first_tool_is_compensated_from_the_first_row_on():
    text = "G21 G90 G94\nG0 X0 Y0 Z50\nG1 X1 Z0 F99\nT1 M6\nG1 X2\nT2 M6\nG1 X3\nM2\n"
    tools = {1: Tool(1, "", 20.0, 4.0, 60.0), 2: Tool(2, "", 8.0, 1.0, 60.0)}
    read, diagnostics = read_content(text.encode(), "a.ngc", ReadingOptions(tools=tools))
    assert read is not None, diagnostics
    program = replace(read, normal=np.tile([0.6, 0, 0.8], (len(read), 1)))
    tips, _ = compensate(program, OffsetOptions(), {1: Tool(1, "", 18.0, 4.0, 60.0)})
    assert tips.position - program.position == pytest.approx(np.array([[-1, 0, 0]] * 3 + [[0, 0, 0]]))
