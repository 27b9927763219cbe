# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a program asks for in compensation is applied once, in 2D and in 3D, before it is placed."""

import argparse
import dataclasses

import numpy as np
import pytest
from cutters import cloud, frame_with_z
from programs import BALL, program

from pkm_post.cli import main
from pkm_post.cli.inputs import add_reading, reading_from
from pkm_post.model import Tool
from pkm_post.options import add_options, options_from
from pkm_post.posting.post_file import prepared_file
from pkm_post.toolpath.compensation.compensate import compensate
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.compensation.offset_options import OffsetOptions
from pkm_post.writing import trajectory_file

CONTOURS = OffsetOptions()


def with_normals():
    made = program([[0, 0, 30], [0, 0, 0], [10, 0, 0], [10, 0, 30]])
    normal = np.full((4, 3), np.nan)
    normal[1:3] = [0.0, 0.6, 0.8]
    return dataclasses.replace(made, normal=normal)


def test_a_program_that_asks_for_nothing_is_left_alone():
    made = program([[0, 0, 30], [10, 0, 30]])
    assert compensate(made, CONTOURS, {}) == (made, ())


def test_contours_are_offset():
    made = dataclasses.replace(program([[-20, 20, 0], [0, 0, 0], [30, 0, 0], [50, 20, 0]]), side_offset=[0, 5, 5, 0])
    moved, reported = compensate(made, CONTOURS, {})
    assert not reported
    assert not moved.side_offset.any()
    assert moved.position[1:3] == pytest.approx(np.array([[0.0, 5.0, 0.0], [30.0, 5.0, 0.0]]))


def test_a_smaller_cutter_goes_nearer_and_is_reported_as_the_tool():
    # A ball of radius 6 and one of 5 that touch the same plane: the tips differ by (r2 - r1) (n - k).
    moved, reported = compensate(with_normals(), CONTOURS, {1: Tool(1, "", 10.0, 5.0, 0.0)})
    assert not reported
    assert moved.position[1] - with_normals().position[1] == pytest.approx([0.0, -0.6, 0.2])
    assert moved.tools[1] == dataclasses.replace(BALL, diameter=10.0, corner_radius=5.0)


@pytest.mark.parametrize(
    ("nominal", "actual", "code"),
    [
        (BALL, {7: BALL}, "N118"),
        (BALL, {1: Tool(1, "", 10.0, 6.0, 0.0)}, "N109"),
        (dataclasses.replace(BALL, diameter=0.0), {1: BALL}, "N109"),
        (dataclasses.replace(BALL, corner_known=False), {1: BALL}, "N117"),
        (BALL, {1: dataclasses.replace(BALL, corner_known=False)}, "N117"),
    ],
    ids=["another number", "a corner that does not fit", "unknown diameter", "unknown corner", "unknown corner now"],
)
def test_a_cutter_that_is_not_known_is_refused(nominal, actual, code):
    moved, reported = compensate(dataclasses.replace(with_normals(), tools={1: nominal}), CONTOURS, actual)
    assert moved is None
    assert [fault.code for fault in reported] == [code]


def test_a_program_without_normals_cannot_be_compensated_for_a_cutter():
    moved, reported = compensate(program([[0, 0, 30], [10, 0, 30]]), CONTOURS, {1: BALL})
    assert moved is None
    assert [fault.code for fault in reported] == ["N108"]


ROUNDING = 1e-7
"""mm; the programs below have nine decimals."""
SAMPLED = 5e-3
"""mm; how far a cloud of points may be from the cutter it stands for."""
Z = np.array([0.0, 0.0, 1.0])
POINTS = 12


def dome(rng, radius=40.0):
    """Points and normals of a ball's surface."""
    angle, turn = rng.uniform(0.3, 1.1, POINTS), rng.uniform(0, 2 * np.pi, POINTS)
    n = np.column_stack([np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn), np.cos(angle)])
    return radius * n, n


def slope(rng):
    """A plane that leans."""
    angle, turn = rng.uniform(0.3, 1.1), rng.uniform(0, 2 * np.pi)
    n = np.array([np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn), np.cos(angle)])
    across = np.cross(n, [0.0, 0.0, 1.0])
    return rng.uniform(-30, 30, (POINTS, 2)) @ np.vstack([across, np.cross(n, across)]), np.tile(n, (POINTS, 1))


def barrel(rng, radius=35.0):
    """A cylinder along y."""
    angle = rng.choice([-1, 1], POINTS) * rng.uniform(0.3, 1.1, POINTS)
    n = np.column_stack([np.sin(angle), np.zeros(POINTS), np.cos(angle)])
    return radius * n + rng.uniform(-30, 30, (POINTS, 1)) * [0.0, 1.0, 0.0], n


def waves(rng, height=1.5, length=40.0):
    """A wave on a slope, z = h sin(2 pi x / l) + x / 2: too steep for a bottom to lie on."""
    x, y = rng.uniform(-10, 10, (2, POINTS))
    w = 2 * np.pi / length
    n = np.column_stack([-height * w * np.cos(w * x) - 0.5, np.zeros(POINTS), np.ones(POINTS)])
    return np.column_stack([x, y, height * np.sin(w * x) + x / 2]), n / np.linalg.norm(n, axis=1)[:, None]


SURFACES = {"dome": dome, "slope": slope, "barrel": barrel, "waves": waves}
CORNERS = {
    "ball": lambda rng, diameter: diameter / 2,
    "bull nose": lambda rng, diameter: round(rng.uniform(0.1, 0.9) * diameter / 2, 3),
    "flat": lambda rng, diameter: 0.0,
}


def tips_of(points, normals, axes, diameter, corner):
    """Equation 7 of the paper, T = P + R1 n + (R - R1) m, with the tip R1 below T.

    The paper's m is level, for an upright tool; where the tool leans, m is square to its axis.
    """
    m = normals - np.sum(normals * axes, axis=1)[:, None] * axes
    m /= np.linalg.norm(m, axis=1)[:, None]
    return points + corner * normals + (diameter / 2 - corner) * m - corner * axes


def program_text(tips, normals, axes):
    words = ("X", "Y", "Z", "NX", "NY", "NZ", "TX", "TY", "TZ")
    block = "LN " + " ".join(f"{word}{{:.9f}}" for word in words) + " F600"
    lines = [block.format(*tip, *n, *k) for tip, n, k in zip(tips, normals, axes, strict=True)]
    return "\n".join(["G21 G90 G94", "T1 M6", "G0 X0 Y0 Z100", *lines, "M30", ""])


def compensated(file, *arguments):
    """The program of a file as the command line reads it, and what was reported."""
    parser = argparse.ArgumentParser()
    add_options(parser)
    add_reading(parser)
    chosen = parser.parse_args(["--axis-words", "vector", "--tool-length", "1=80", *arguments])
    read = prepared_file(file, options=options_from(chosen), tool_lengths={1: 80.0}, reading=reading_from(chosen))
    assert {fault.code for fault in read.found} <= {"V131"}, "the cuts end where the cutter stands in the surface"
    return compensate(read.program, read.options.contours, read.options.actual_tools)


@pytest.mark.slow
@pytest.mark.parametrize("upright", [True, False], ids=["upright", "leaning"])
@pytest.mark.parametrize("kind", CORNERS)
@pytest.mark.parametrize("surface", SURFACES)
def test_random_cutters_touch_where_the_nominal_ones_did(tmp_path, surface, kind, upright):
    rng = np.random.default_rng([list(SURFACES).index(surface), list(CORNERS).index(kind), upright])
    file = tmp_path / "part.ngc"
    for _ in range(3):
        points, normals = SURFACES[surface](rng)
        lean = rng.normal(size=(POINTS, 3)) * (0.0 if upright else 0.15)
        axes = Z + lean
        axes /= np.linalg.norm(axes, axis=1)[:, None]
        (d1, d2) = np.round(rng.uniform(6, 16, 2), 3)
        r1, r2 = CORNERS[kind](rng, d1), CORNERS[kind](rng, d2)
        file.write_text(program_text(tips_of(points, normals, axes, d1, r1), normals, axes))
        moved, reported = compensated(file, f"--tool=1={d1},{r1}", f"--actual-tool=1={d2},{r2}")
        assert not reported
        tips = moved.position[1:]
        assert tips == pytest.approx(tips_of(points, normals, axes, d2, r2), abs=ROUNDING)
        # and without any formula: points all over the cutter, the nearest on the tangent plane and none behind it
        body = cloud(Cutter.apt(d2, r2), 30.0, 360, 100)
        for tip, point, normal, axis in zip(tips, points, normals, axes, strict=True):
            height = (body @ frame_with_z(axis).T + tip - point) @ normal
            assert 0.0 - ROUNDING <= height.min() <= SAMPLED


LN = """\
G21 G90 G94
T1 M6
G0 X0 Y0 Z30
LN X0 Y0 Z20 NX0 NY0.6 NZ0.8 F600
LN X0.5 Y0 Z20 NX0 NY0.6 NZ0.8
G0 Z30
M30
"""
"""A ball nose of 10 mm on a slope."""
POST = ("--axis-words=vector", "--work-offset=0,0,250", "--tool-length=1=80")


def test_a_worn_ball_nose_is_posted_where_it_touches(tmp_path):
    # (r2 - r1) (n - k) with r2 - r1 = -0.2: (0, -0.12, 0.04) beside the tip at (0, 0, 20)
    file = tmp_path / "part.ngc"
    file.write_text(LN)
    cutters = ("--tool", "1=10,5", "--actual-tool", "1=9.6,4.8")
    assert main(["post", str(file), *POST, *cutters, "--out", str(tmp_path / "out")]) == 0
    trajectory, _ = trajectory_file.read(tmp_path / "out" / "part.pkmt")
    assert trajectory.tip[1] - [0.0, 0.0, 250.0] == pytest.approx([0.0, -0.12, 20.04], abs=ROUNDING)
    assert (trajectory.tools[1].diameter, trajectory.tools[1].corner_radius) == (9.6, 4.8)


@pytest.mark.parametrize(
    ("cutters", "code"),
    [
        (["--tool=1=10", "--actual-tool=1=9.6,4.8"], "N117"),
        (["--tool=1=10,5", "--actual-tool=1=9.6"], "N117"),
        (["--actual-tool=1=9.6,4.8"], "N109"),
        (["--tool=1=10,5", "--actual-tool=2=9.6,4.8"], "N118"),
    ],
)
def test_what_is_not_said_of_a_cutter_is_asked_for(tmp_path, capsys, cutters, code):
    file = tmp_path / "part.ngc"
    file.write_text(LN)
    assert main(["post", str(file), *POST, *cutters, "--out", str(tmp_path / "out")]) == 1
    reported = capsys.readouterr().err
    assert code in reported
    assert "--tool NUMBER=D,R" in reported or "--actual-tool with the number" in reported
    assert not any((tmp_path / "out").glob("*"))


def test_a_program_that_calls_no_tool_has_number_0(tmp_path):
    file = tmp_path / "part.ngc"
    file.write_text(LN.replace("T1 M6\n", ""))
    out = tmp_path / "out"
    cutters = ("--tool-length=0=80", "--tool=0=10,5", "--actual-tool=0=9.6,4.8")
    assert main(["post", str(file), *POST[:2], *cutters, "--out", str(out)]) == 0
    assert trajectory_file.read(out / "part.pkmt")[0].tip[1] == pytest.approx([0.0, -0.12, 270.04], abs=ROUNDING)


@pytest.mark.parametrize("command", [["check"], ["convert", "--to=gcode:vector", "--out=made.ngc"]])
def test_check_and_convert_take_the_corner_as_well(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.ngc").write_text(LN)
    assert main([*command, "part.ngc", "--axis-words=vector", "--tool=1=10,5"]) == 0
    if command[0] == "convert":
        assert "(tool 1, diameter 10 mm, corner radius 5 mm)" in (tmp_path / "made.ngc").read_text()


def test_a_cutter_of_cl_data_keeps_its_name_and_length(tmp_path):
    file = tmp_path / "part.cls"
    file.write_text(
        "UNITS/MM\nTLDATA/MILL,10,5,50,0,0\nLOADTL/1,LENGTH,80\nFEDRAT/600,MMPM\nGOTO/0,0,0\nGOTO/9,0,0\nFINI\n"
    )
    parser = argparse.ArgumentParser()
    add_options(parser)
    add_reading(parser)
    reading = reading_from(parser.parse_args(["--tool=1=9.6,4.8"]))
    tool = prepared_file(file, reading=reading).program.tools[1]
    assert (tool.diameter, tool.corner_radius, tool.length, tool.corner_known) == (9.6, 4.8, 80.0, True)
