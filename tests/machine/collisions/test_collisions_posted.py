# SPDX-License-Identifier: LGPL-2.1-or-later
"""What runs into part, stock or fixture is not posted by the command line, and nothing is written; what clears is."""

import json
import re

import numpy as np
import pytest
from machines import example
from meshes import ascii_stl, binary_stl, box
from programs import BALL, ON_PALLET, program

from pkm_post.cli import main
from pkm_post.machine import find_collisions
from pkm_post.model import Event, EventKind, Kind, Mesh, Setup, Shank, Tolerances, Tool
from pkm_post.toolpath.place import place

SLOT = """\
G21 G90 G54
T1 M6
S8000 M3
G0 X-30 Y0 Z60
G0 Z20.5
G1 Z10 F600
G1 X30
G1 Y10
G0 Z60
M5
M30
"""
"""Upright, gauge length 120: the holder of the example machine, of 25 mm radius, begins 70 mm above the tip."""
NARROW = Tolerances(0.001, 1e-5)
PLATE, CLEARANCE = box([-40, -40, 0], [40, 40, 10]), 2.0

POST = np.concatenate([PLATE, box([38, -5, 10], [42, 12, 30])])


def wall(gap):
    """A wall that the holder passes at this distance, at Y10."""
    return box([-40, 10 + 25 + gap, 10], [40, 60, 115])


def posted(folder, capsys, *arguments, program=SLOT):
    """Exit code, what was written, and what was reported."""
    (folder / "slot.ngc").write_text(program)
    out = folder / "out"
    flags = ["--machine", "example_6tps", "--out", str(out), "--tool-length", "1=120", "--tool", "1=10,0"]
    code = main(["post", str(folder / "slot.ngc"), *flags, *arguments])
    return code, sorted(path.name for path in out.glob("*")) if out.exists() else [], capsys.readouterr().err


def stored(folder, name, mesh):
    (folder / name).write_bytes(binary_stl(mesh) if name.startswith("b") else ascii_stl(mesh))
    return str(folder / name)


@pytest.mark.slow
@pytest.mark.parametrize(("gap", "code"), [(CLEARANCE + 0.1, 0), (CLEARANCE - 0.1, 1), (-15.0, 1)])
@pytest.mark.parametrize("name", ["binary.stl", "ascii.stl"])
def test_a_holder_that_goes_into_the_part_is_refused_and_one_that_clears_is_posted(tmp_path, capsys, gap, code, name):
    part = stored(tmp_path, name, np.concatenate([PLATE, wall(gap)]))
    found, files, reported = posted(tmp_path, capsys, "--part", part)
    assert (found, bool(files)) == (code, code == 0), reported
    assert bool(re.search(r"line [89]: error K117.*tool holder", reported)) == bool(code)


def test_what_was_checked_is_in_the_report(tmp_path, capsys):
    part, stock = stored(tmp_path, "part.stl", PLATE), stored(tmp_path, "stock.stl", box([-40, -40, 0], [40, 40, 20]))
    code, _, reported = posted(tmp_path, capsys, "--part", part, "--stock", stock)
    assert code == 0, reported
    certificate = json.loads((tmp_path / "out/slot-report.json").read_text())["certificate"]
    rows = {row["what"]: row for row in certificate["coverage"] if row["topic"] == "collisions"}
    held = rows["spindle and holder against the part"]
    assert held["extent"] == "proven" and held["detail"] == "part.stl, 12 triangles, along the whole path"
    assert rows["struts against the part"]["extent"] == "proven"
    assert rows["shanks against the part"]["extent"] == "not covered"
    assert rows["machine and rapid moves against the stock"]["extent"] == "sampled"
    assert rows["machine and tool against clamps and fixtures"]["extent"] == "not covered"


def test_nothing_known_is_said(tmp_path, capsys):
    code, _, _ = posted(tmp_path, capsys)
    assert code == 0
    certificate = json.loads((tmp_path / "out/slot-report.json").read_text())["certificate"]
    (row,) = [row for row in certificate["coverage"] if row["what"] == "machine and tool against the part"]
    assert (row["extent"], row["detail"]) == ("not covered", "part: not known")


@pytest.mark.parametrize(
    ("flag", "mesh", "change", "reported"),
    [
        # A rapid move through a post of the part, which is clear of the holder
        ("--part", POST, ("G0 Z60", "G0 Z12\nG0 X60"), "line 10: error K131"),
        # A rapid move down into the stock, and one sideways through it
        ("--stock", box([-40, -40, 0], [40, 40, 22]), ("G0 Z20.5", "G0 Z15"), "line 5: error K136"),
        ("--stock", box([-40, -40, 0], [40, 40, 20]), ("G0 Z60", "G0 X0 Y-20"), "line 9: error K136"),
        # A clamp in the way of the cutter, and one in that of the holder
        ("--fixture", box([20, -2, 0], [24, 2, 12]), ("", ""), "line 7: error K133"),
        ("--fixture", box([20, -30, 0], [24, -20, 120]), ("", ""), "error K133"),
    ],
)  # fmt: skip
@pytest.mark.slow
def test_each_kind_of_collision_is_refused(tmp_path, capsys, flag, mesh, change, reported):
    mesh = stored(tmp_path, "mesh.stl", mesh)
    code, files, errors = posted(tmp_path, capsys, flag, mesh, program=SLOT.replace(*change, 1) if change[0] else SLOT)
    assert code == 1 and not files and reported in errors, errors


@pytest.mark.slow
def test_a_cutter_that_gouges_is_posted_with_a_warning(tmp_path, capsys):
    code, files, reported = posted(
        tmp_path, capsys, "--part", stored(tmp_path, "p.stl", box([-40, -40, 0], [40, 40, 11]))
    )
    assert code == 0 and files and "warning K132" in reported
    code, _, reported = posted(tmp_path, capsys, "--part", stored(tmp_path, "p.stl", PLATE))
    assert code == 0 and "K132" not in reported


def test_a_rapid_move_back_through_what_was_cut_is_posted(tmp_path, capsys):
    stock = stored(tmp_path, "stock.stl", box([-40, -40, 0], [40, 40, 20]))
    back = SLOT.replace("G0 Z60\nM5", "G0 Y0\nG0 X-30\nG0 Z60\nM5")
    code, _, reported = posted(tmp_path, capsys, "--stock", stock, program=back)
    assert code == 0 and not reported, reported


FACED = SLOT.replace("G0 Z60\nM5", "G0 Z20\nG0 X{0} Y0\nG0 Z{1}\nG0 Z60\nM5")
"""The top of the part is finished, then the cutter goes down to a height, in rapid motion."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("place", "height", "code"), [(0, 9.8, 0), (0, 7.0, 1), (0, -5.0, 1), (33, 7.0, 1), (50, 7.0, 0)]
)
def test_a_rapid_move_through_a_finished_face_is_refused(tmp_path, capsys, place, height, code):
    part = stored(tmp_path, "part.stl", PLATE)
    found, files, reported = posted(tmp_path, capsys, "--part", part, program=FACED.format(place, height))
    assert (found, bool(files), "line 11: error K131" in reported) == (code, not code, bool(code)), reported


@pytest.mark.parametrize(
    ("mesh", "behind"),
    [
        (PLATE, r"sampled.*cut before, in \d\d,\d{3} points 1 mm apart"),
        (PLATE[1:], "sampled.*not looked at: open mesh"),
    ],
)
def test_a_rapid_move_out_of_a_hole_that_the_part_does_not_have_is_posted(tmp_path, capsys, mesh, behind):
    drilled = FACED.format(0, 10.5).replace("G0 Z60\nM5", "G1 Z4\nG0 Z10.5\nG0 Z5\nG0 Z60\nM5")
    code, _, reported = posted(tmp_path, capsys, "--part", stored(tmp_path, "p.stl", mesh), program=drilled)
    assert code == 0 and "K132" in reported, reported
    certificate = json.loads((tmp_path / "out/slot-report.json").read_text())["certificate"]
    (row,) = [row for row in certificate["coverage"] if row["what"] == "cutters in rapid moves against the part"]
    assert re.search(behind, row["extent"] + row["detail"]), row


SLANTED = """\
UNITS/MM
CUTTER/20,0,{},60
LOADTL/1
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,-30,60
{}
GOTO/0,0,60
FEDRAT/500,MMPM
GOTO/0,30,60
RAPID
GOTO/0,30,90
FINI
"""


@pytest.mark.slow
@pytest.mark.parametrize("what", ["--part", "--fixture"])
@pytest.mark.parametrize(
    ("angles", "beside", "top", "clear"),
    [
        ("0,0,45,0", 0.0, 61.0, 59.8),
        ("0,0,45,0", 5.0, 66.0, 64.5),
        ("0,0,0,10", 0.0, 61.0, 59.8),
        ("0,0,0,10", 10.0, 64.0, 59.8),
        ("0,0,0,45", 19.0, 70.0, 68.5),
    ],
)
def test_a_rapid_move_of_a_slanted_cutter_meets_a_post(tmp_path, capsys, what, angles, beside, top, clear):
    (tmp_path / "job.cls").write_text(SLANTED.format(angles, "RAPID"))
    for height, code in ((top, 1), (clear, 0)):
        post = stored(tmp_path, "post.stl", box([beside, -2, 0], [beside + 1, -1, height]))
        flags = ["--machine", "example_6tps", "--out", str(tmp_path / "out"), "--tool-length", "1=120", what, post]
        found, reported = main(["post", str(tmp_path / "job.cls"), *flags]), capsys.readouterr().err
        assert (found, bool(re.search("K131|K133", reported))) == (code, bool(code)), reported


@pytest.mark.slow
@pytest.mark.parametrize(("gap", "degrees", "code"), [(0.5, "0.001", 0), (0.5, "1", 1), (2.5, "1", 0)])
def test_a_fixture_clears_the_cutter_of_any_axis_within_its_tolerance(tmp_path, capsys, gap, degrees, code):
    clamp = stored(tmp_path, "clamp.stl", box([20, 15 + gap, 0], [40, 30, 70]))
    found, _, reported = posted(tmp_path, capsys, "--fixture", clamp, "--axis-tolerance", degrees)
    assert (found, "error K133" in reported) == (code, bool(code)), reported


@pytest.mark.slow
@pytest.mark.parametrize(("gap", "hit"), [(-0.3, True), (0.1, True), (0.4, True), (0.6, False)])
def test_a_shank_clears_a_fixture_by_the_tolerance_of_the_tool_tip(gap, hit):
    trajectory, faults = place(program([[-30, 0, 0], [30, 0, 0]]), example(), ON_PALLET)
    assert not faults
    clamp = Mesh("clamp.stl", box([-10, 8 + gap, 60], [10, 30, 68]))
    setup = Setup(fixtures=(clamp,), shanks={BALL.number: Shank(20.0, 16.0)})
    found = find_collisions(trajectory, example(), setup, Tolerances(0.5, 1e-6)).faults
    assert [fault.code for fault in found] == ["K133"] * hit


@pytest.mark.parametrize(
    ("name", "content", "reported"),
    [
        ("part.obj", b"v 0 0 0", "expected a name that ends in .stl or .step or .stp"),
        ("part.stl", b"solid x\nfacet normal 0 0 1\nouter lop", "part.stl: line 3: error K138"),
        ("part.stl", None, "F103"),
    ],
)
def test_files_that_cannot_be_read_are_refused_by_name(tmp_path, capsys, name, content, reported):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    code, files, errors = posted(tmp_path, capsys, "--part", str(tmp_path / name))
    assert code == 1 and not files and reported in errors, errors


@pytest.mark.parametrize(("height", "code"), [(25, 0), (15, 1)])
def test_a_tool_that_only_moves_in_rapids_is_checked_with_the_stock(tmp_path, capsys, height, code):
    stock = stored(tmp_path, "stock.stl", box([-40, -40, 0], [40, 40, 20]))
    unused = SLOT.replace("M5\nM30", f"T2 M6\nG0 X0 Y-20\nG0 Z{height}\nG0 Z60\nM5\nM30")
    tools = "--stock", stock, "--tool-length", "2=120", "--tool", "2=8,0"
    found, _, reported = posted(tmp_path, capsys, *tools, program=unused)
    assert (found, "error K136" in reported) == (code, bool(code)), reported


def test_an_open_mesh_of_the_stock_is_reported(tmp_path, capsys):
    stock = stored(tmp_path, "stock.stl", box([-40, -40, 0], [40, 40, 20])[1:])
    code, _, reported = posted(tmp_path, capsys, "--stock", stock)
    assert code == 0 and "stock.stl: warning K139" in reported


def test_a_long_program_is_looked_at_in_steps_as_short_as_a_short_one():
    """Three thousand passes beside the stock, then a rapid move through a thin wall, in the middle of its 100 mm."""
    passes = np.linspace(-40, 40, 3000)
    rows = [[-60, 29.9], [-45, 29.9], [-60, 29.9], [-60, 45], [60, 45], [-60, 45]]
    tips = np.array([[x, y, z] for y in passes for x, z in rows] + [[-60, 0, 20], [60, 0, 20]])
    kinds = [Kind.RAPID, Kind.LINE, Kind.LINE, Kind.RAPID, Kind.RAPID, Kind.RAPID] * 3000 + [Kind.RAPID] * 2
    trajectory, faults = place(
        program(tips, kind=kinds, tools={1: Tool(1, "mill", 10.0, 0.0, 120.0)}), example(), ON_PALLET
    )
    assert not faults
    wall = Mesh("s.stl", np.concatenate([box([-50, -50, 0], [50, 50, 10]), box([-2.5, -50, 10.001], [2.5, 50, 32])]))
    found = find_collisions(trajectory, example(), Setup(stock=wall), Tolerances(0.001, 1e-5))
    assert "K136" in {fault.code for fault in found.faults}
    (row,) = [row for row in found.coverage if row.subject == "machine and rapid moves against the stock"]
    deeper, apart = re.search(r"deeper than (\S+) mm, every (\S+) mm", row.detail).groups()
    assert float(deeper) < 0.3 and float(apart) < 2.0, row.detail


@pytest.mark.parametrize("wide", [0.0, 1.0, 1.5])
def test_a_ridge_left_in_a_pocket_is_met_by_rapid_moves_all_over_its_floor(wide):
    """They meet 24,000 points of the stock, all cut before but the few of the ridge, which is 2.5 mm high."""
    rows = []
    for y in range(-40, 41, 8):
        ridge = [[10, y, 10], [10, y, 13], [20 + wide, y, 13], [20 + wide, y, 10]] if y == 0 else []
        for cut in ([[40, y, 15]], [*ridge, [40, y, 10]]):
            rows += [[-40, y, 40, Kind.RAPID], *([*at, Kind.LINE] for at in ([-40, y, cut[-1][2]], *cut, [40, y, 40]))]
    for y in range(-40, 41, 8):
        back = [[-39.9, y, 40, Kind.RAPID], [-39.9, y, 10.1, Kind.LINE], [39.9, y, 10.1, Kind.RAPID]]
        rows += [*back, [39.9, y, 40, Kind.LINE]]
    *tips, kinds = zip(*rows, strict=True)
    tool = Tool(1, "mill", 10.0, 0.0, 120.0)
    trajectory, faults = place(program(np.transpose(tips), kind=kinds, tools={1: tool}), example(), ON_PALLET)
    assert not faults
    stock = Mesh("stock.stl", box([-50, -50, 0], [50, 50, 20]))
    found = find_collisions(trajectory, example(), Setup(stock=stock), NARROW).faults
    assert [fault.code for fault in found] == ["K137"]


def test_a_point_that_is_thinner_than_the_allowance_is_checked_without_a_cutter():
    tool = Tool(1, "point", 1.0, 0.0, 120.0, bottom_angle=np.radians(75))
    trajectory, faults = place(program([[-30, 0, 0], [30, 0, 0]], tools={1: tool}), example(), ON_PALLET)
    assert not faults
    setup = Setup(part=Mesh("part.stl", PLATE - [0, 0, 10.2]), shanks={1: Shank(0.5, 6.0)})
    assert not find_collisions(trajectory, example(), setup, Tolerances(0.001, 1e-5)).faults


@pytest.mark.slow
@pytest.mark.parametrize("half", [10, 30, 45, 70])
@pytest.mark.parametrize(("aside", "found"), [(0.0, set()), (4.0, {"K136"})])
def test_a_rapid_move_in_the_groove_of_a_pointed_cutter_meets_nothing(half, aside, found):
    """A point cuts less than the widest diameter promises: between two poses as far apart as for that, ridges stay."""
    tool = Tool(1, "v", 16.0, 0.0, 120.0, bottom_angle=np.radians(90 - half))
    groove, back = [[-20, 0, 9.9], [20, 0, 9.9]], [[20, aside, 10], [-20, aside, 10]]
    rows = [[-20, 0, 40], *groove, [20, 0, 40], [20, aside, 40], *back, [-20, aside, 40]]
    kinds = [Kind.RAPID, Kind.LINE, Kind.LINE, *[Kind.RAPID] * 5]
    trajectory, faults = place(program(rows, kind=kinds, tools={1: tool}), example(), ON_PALLET)
    assert not faults
    stock = Mesh("stock.stl", box([-15, -7, 5], [15, 7, 13]))
    collisions = find_collisions(trajectory, example(), Setup(stock=stock, shanks={1: Shank(30.0, 16.0)}), NARROW)
    assert {fault.code for fault in collisions.faults} == found


@pytest.mark.parametrize(("cores", "codes"), [({}, []), ({1: 3.0}, ["K137"])])
def test_a_tool_cuts_for_certain_only_with_its_core(cores, codes):
    """The next tool is in its slot, 2 mm aside: a neck of 3 mm may have left stock where a cylinder of 10 mm cuts."""
    tools = {number: Tool(number, "", size, 0.0, 120.0) for number, size in ((1, 10.0), (2, 4.0))}
    way = [[-20, 0, 20], [-20, 0, -3], [20, 0, -3], [20, 0, 20], [20, 2, 20], [20, 2, -3], [-20, 2, -3], [-20, 2, 20]]
    kinds = [Kind.RAPID, Kind.LINE, Kind.LINE, *[Kind.RAPID] * 5]
    changes = tuple(Event(row, EventKind.TOOL_CHANGE, number) for row, number in ((0, 1), (4, 2)))
    trajectory, faults = place(program(way, kind=kinds, tools=tools, events=changes), example(), ON_PALLET)
    assert not faults
    shanks = {1: Shank(10.0, 3.0), 2: Shank(10.0, 4.0)}
    setup = Setup(stock=Mesh("stock", box([-25, -20, -8], [25, 20, 0])), shanks=shanks, cores=cores)
    assert [fault.code for fault in find_collisions(trajectory, example(), setup, NARROW).faults] == codes
