# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every form of an arc against the same arc written as CIRCLE with its end after it, and against hand-made numbers."""

import numpy as np
import pytest

from pkm_post.geometry import arc_sweep
from pkm_post.geometry.curves import arc_length, arc_points
from pkm_post.model import Kind
from pkm_post.model.diagnostics import errors
from pkm_post.reading.cldata import ReadOptions, read

MICRON = 1e-3
HEAD = "UNITS/MM\nLOADTL/1,LENGTH,100\nCUTTER/10\nFEDRAT/600,MMPM\n"
START = HEAD + "GOTO/10,0,0\n"
CANON = "(CIRCLE/CANON,0,0,0,0,0,1,10)"
HALF = 10 * np.sqrt(0.75)  # 8.660254, the other side of a right triangle of 5 and 10


def program(text, **options):
    found, diagnostics = read(text, "part.cl", ReadOptions(**options))
    assert not errors(diagnostics), [str(fault) for fault in diagnostics]
    return found


def numbers(*values):
    """Numbers as CL data has them, with nine decimals."""
    return ",".join(f"{value:.9f}" for value in np.hstack(values))


def turned(found):
    """The angle that the arcs of a program turn in all, rad."""
    arcs = np.flatnonzero(found.kind == Kind.ARC)
    sweeps = arc_sweep(found.position[arcs - 1], found.position[arcs], found.arc_centre[arcs], found.arc_axis[arcs])
    return float(np.sum(sweeps))


def same_arc(found, other):
    """Whether the last moves of two programs are one arc."""
    assert found.kind[-1] == other.kind[-1] == Kind.ARC
    assert found.position[-1] == pytest.approx(other.position[-1], abs=MICRON)
    assert found.arc_centre[-1] == pytest.approx(other.arc_centre[-1], abs=MICRON)
    assert found.arc_axis[-1] == pytest.approx(other.arc_axis[-1], abs=1e-6)
    assert turned(found) == pytest.approx(turned(other), abs=1e-6)


class Circle:
    """A circle at random in space, an arc on it, and both as text."""

    def __init__(self, random):
        self.centre = random.normal(0, 50, 3)
        self.axis = unit(random.normal(0, 1, 3))
        self.radius = random.uniform(2, 40)
        self.angle = random.uniform(0.1, 2 * np.pi - 0.1)
        self.way = random.choice([-1, 1])
        self.u = unit(np.cross(self.axis, random.normal(0, 1, 3)))
        self.v = self.way * np.cross(self.axis, self.u)
        self.goto = HEAD + f"GOTO/{numbers(self.at(0))}\n"
        self.canon = numbers(self.centre, self.axis, self.radius)
        self.plain = program(
            f"{self.goto}CIRCLE/{numbers(self.centre, self.way * self.axis, self.radius)}\n"
            f"GOTO/{numbers(self.at(self.angle))}\n",
            hand="right",
        )

    def at(self, angle):
        return self.centre + self.radius * (np.cos(angle) * self.u + np.sin(angle) * self.v)

    def out(self, angle):
        return (self.at(angle) - self.centre) / self.radius

    def along(self, angle):
        return -np.sin(angle) * self.u + np.cos(angle) * self.v


def unit(vector):
    return vector / np.linalg.norm(vector)


def plane(normal, point):
    return f"(PLANE/{numbers(normal, normal @ point)})"


@pytest.fixture(params=range(12))
def circle(request):
    return Circle(np.random.default_rng([41, request.param]))


def test_on_a_plane_through_the_axis(circle):
    """The plane through axis and end crosses the circle at the end and half a turn from it."""
    number = "" if circle.angle < np.pi else "2,INTOF,"
    check = plane(circle.along(circle.angle), circle.centre)
    psis = f"PSIS/{plane(-circle.axis, circle.centre)}\nINDIRP/{numbers(circle.at(0.05))}\n"
    same_arc(program(f"{circle.goto}{psis}TLON,GOFWD/(CIRCLE/CANON,{circle.canon}),ON,{number}{check}\n"), circle.plain)


def test_on_a_plane_through_two_points_of_the_circle(circle):
    """The number selects one of the two intersections."""
    other = np.random.default_rng(7).uniform(0.1, 6.1)
    number = 1 if circle.angle < other else 2
    normal = unit(np.cross(circle.axis, circle.at(other) - circle.at(circle.angle))) + 0.3 * circle.axis
    point = circle.at(other)
    check = f"(PLANE/(POINT/{numbers(point)}),PERPTO,(VECTOR/{numbers(3 * normal)}))"
    guide = f"INDIRV/{numbers(circle.along(0))}\nTLON,GOFWD/(CYLNDR/{circle.canon}),ON,{number},INTOF,{check}\n"
    same_arc(program(circle.goto + guide), circle.plain)


def test_until_a_plane_touches_the_circle(circle):
    check = plane(circle.out(circle.angle), circle.at(circle.angle))
    guide = f"INDIRV/{numbers(circle.along(0) + 2 * circle.out(0))}\nTLON,GOFWD/(CIRCLE/{circle.canon}),TANTO,{check}\n"
    same_arc(program(circle.goto + guide), circle.plain)


def test_until_a_line_touches_the_circle(circle):
    end, along = circle.at(circle.angle), circle.along(circle.angle)
    check = f"(LINE/{numbers(end - 5 * along, end + 9 * along)})"
    guide = f"INDIRV/{numbers(circle.along(0))}\nTLON,GOFWD/(CIRCLE/{circle.canon}),TANTO,{check}\n"
    same_arc(program(circle.goto + guide), circle.plain)


def test_a_plane_through_the_centre_and_the_end_as_catia_writes_circles_in_space(circle):
    """[CATIA]: PSIS is the plane of the circle; the check plane is perpendicular to it, and its last point the end."""
    ends = f"(POINT/{numbers(circle.centre)}),(POINT/{numbers(circle.at(circle.angle))})"
    own = f"(PLANE/(POINT/{numbers(circle.centre)}),PERPTO,(VECTOR/{numbers(circle.axis)}))"
    psis = f"PSIS/{own}\nINDIRV/{numbers(circle.along(0))}\n"
    guide = f"{psis}TLON,GOFWD/(CYLNDR/{circle.canon}),ON,(PLANE/PERPTO,{own},{ends})\n"
    same_arc(program(circle.goto + guide), circle.plain)
    other = guide.replace(f"PERPTO,{own}", f"PERPTO,{plane(circle.along(0), circle.centre)}")
    assert [fault.code for fault in errors(read(circle.goto + other, "part.cl")[1])] == ["L408"]


def test_a_line_from_the_centre_to_the_end(circle):
    number = "2,INTOF," if circle.angle > np.pi else ""
    check = f"(LINE/{numbers(circle.centre, circle.at(circle.angle))})"
    guide = f"INDIRV/{numbers(circle.along(0))}\nTLON,GOFWD/(CIRCLE/CANON,{circle.canon}),ON,{number}{check}\n"
    same_arc(program(circle.goto + guide), circle.plain)


def test_arcmov_turns_about_the_axis_of_arcdat(circle):
    word = "CCLW" if circle.way > 0 else "CLW"
    move = f"ARCMOV/{word},{numbers(circle.at(circle.angle), np.degrees(circle.angle))}\n"
    same_arc(program(f"{circle.goto}ARCDAT/{circle.canon}\n{move}"), circle.plain)


@pytest.mark.parametrize("form", ["GO{}/{axis_behind},{end}", "{}/{axis},{start},{centre},{end},{radius}"])
@pytest.mark.parametrize("flipped", [1, -1])
def test_clockwise_is_seen_from_the_holder(circle, form, flipped):
    """Whichever way the axis of the circle is written, the tool axis says what clockwise is."""
    words = ("CCLW", "CLW") if form.startswith("GO") else ("CCW", "CW")
    axis = flipped * circle.axis
    move = form.format(
        words[int(circle.way < 0)],
        axis_behind=numbers(circle.centre, axis, circle.radius),
        axis=numbers(axis), start=numbers(circle.at(0)), centre=numbers(circle.centre),
        end=numbers(circle.at(circle.angle)), radius=numbers(circle.radius),
    )  # fmt: skip
    tool = f"MULTAX\n{HEAD}GOTO/{numbers(circle.at(0), circle.axis)}\n"
    same_arc(program(f"{tool}{move}\n"), circle.plain)


def test_points_that_follow_lie_on_the_arc(circle):
    """The hand of the dialect does not matter: the points say which way round."""
    angles = np.append(np.arange(0.9, circle.angle, 0.9), circle.angle)
    points = "".join(f"{numbers(circle.at(angle))}\n" for angle in angles)
    found = program(f"{circle.goto}CIRCLE/{circle.canon}\nGOTO/{points}", hand="left")
    assert (found.kind[1:] == Kind.ARC).all()
    assert found.arc_axis[1:] == pytest.approx(np.tile(circle.way * circle.axis, (len(angles), 1)), abs=1e-6)
    same_arc(found, circle.plain)


def test_a_circle_in_a_comment_takes_the_points_that_lie_on_it(circle):
    angles = np.append(np.arange(0.2, circle.angle, 0.2), circle.angle)
    points = "".join(f"GOTO/{numbers(circle.at(angle))}\n" for angle in angles)
    off = f"GOTO/{numbers(circle.centre)}\nGOTO/{numbers(circle.at(0.1))}\n"
    found = program(f"{circle.goto}$$ CIRCLE/{circle.canon}\n{points}{off}")
    arcs = found.kind == Kind.ARC
    assert arcs.tolist() == [False, *[True] * len(angles), False, False]
    assert turned(found) == pytest.approx(circle.angle, abs=1e-6)
    assert found.arc_axis[arcs] == pytest.approx(np.tile(circle.way * circle.axis, (len(angles), 1)), abs=1e-6)


@pytest.mark.parametrize(
    "way, motion, end, degrees",
    [
        (1, f"{CANON},ON,(PLANE/1,0,0,5)", (5, HALF, 0), 60),
        (-1, f"{CANON},ON,(PLANE/1,0,0,5)", (5, -HALF, 0), 60),
        (1, f"{CANON},ON,1,INTOF,(PLANE/1,0,0,5)", (5, HALF, 0), 60),
        (1, f"{CANON},ON,2,INTOF,(PLANE/1,0,0,5)", (5, -HALF, 0), 300),
        (-1, f"{CANON},ON,2,INTOF,(PLANE/1,0,0,5)", (5, HALF, 0), 300),
        (1, f"{CANON},ON,(PLANE/-4,0,0,-20)", (5, HALF, 0), 60),
        (1, f"{CANON},ON,(PLANE/CANON,1,0,0,5)", (5, HALF, 0), 60),
        (1, f"{CANON},ON,(LINE/5,-20,0,5,20,0)", (5, HALF, 0), 60),
        (1, f"{CANON},ON,2,INTOF,(LINE/5,20,0,5,-20,0)", (5, -HALF, 0), 300),
        (1, f"{CANON},ON,(PLANE/0,1,0,0)", (-10, 0, 0), 180),
        (1, f"{CANON},ON,2,INTOF,(PLANE/0,1,0,0)", (10, 0, 0), 360),
        (-1, f"{CANON},ON,2,INTOF,(PLANE/0,1,0,0)", (10, 0, 0), 360),
        (1, f"{CANON},ON,(PLANE/0,1,0,10)", (0, 10, 0), 90),
        (1, f"{CANON},ON,(PLANE/0,1,0,10.0005)", (0, 10, 0), 90),
        (1, f"{CANON},TANTO,(PLANE/0,1,0,-10)", (0, -10, 0), 270),
        (-1, f"{CANON},TANTO,(PLANE/0,1,0,-10)", (0, -10, 0), 90),
        (1, f"{CANON},TANTO,(PLANE/1,0,0,10)", (10, 0, 0), 360),
        (1, f"{CANON},TANTO,(LINE/-3,10,0,3,10,0)", (0, 10, 0), 90),
        (1, "(CIRCLE/0,0,0,10),ON,(LINE/0,0,0,0,10,0)", (0, 10, 0), 90),
        (-1, "(CIRCLE/0,0,0,10),ON,(LINE/0,0,0,0,10,0)", (0, 10, 0), 270),
        (1, "(CIRCLE/0,0,0,10),ON,2,INTOF,(LINE/0,0,0,0,-10,0)", (0, -10, 0), 270),
        (1, "(CIRCLE/0,0,0,10),ON,2,INTOF,(LINE/0,0,0,10,0,0)", (10, 0, 0), 360),
        (1, "(CYLNDR/0,0,0,0,0,1,10),ON,(PLANE/(POINT/5,0,0),PERPTO,(VECTOR/2,0,0))", (5, HALF, 0), 60),
    ],
)  # fmt: skip
def test_ends_worked_out_by_hand(way, motion, end, degrees):
    """The tool starts at 10,0,0 on a circle of radius 10 about the origin, upwards (1) or downwards (-1)."""
    found = program(f"{START}AUTOPS\nINDIRV/0,{way},0\nTLON,GOFWD/{motion}\n")
    assert found.position[-1] == pytest.approx(np.array(end), abs=1e-9)
    assert np.degrees(turned(found)) == pytest.approx(degrees, abs=1e-9)
    assert found.arc_axis[-1] == pytest.approx([0, 0, way])


def test_arcs_go_on_from_one_another_and_from_increments():
    quarter = f"TLON,GOFWD/{CANON},ON,(PLANE/{{}})\n"
    text = f"INDIRV/0,1,0\n{quarter.format('1,0,0,0')}INDIRP/-5,5,0\n{quarter.format('0,1,0,0')}"
    found = program(f"{HEAD}GOTO/4,0,0\nGODLTA/6,0,0\n{text}GODLTA/0,0,5\n")
    assert found.position[1:] == pytest.approx(np.array([[10, 0, 0], [0, 10, 0], [-10, 0, 0], [-10, 0, 5]]), abs=1e-9)
    assert found.kind[1:].tolist() == [Kind.LINE, Kind.ARC, Kind.ARC, Kind.LINE]


def test_a_change_of_unit_or_frame_does_not_move_the_tool():
    inches = "UNITS/INCHES\nINDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,0,1),ON,(PLANE/1,0,0,0)\n"
    found = program(f"{HEAD}GOTO/25.4,0,0\n{inches}GODLTA/0,1,0\n")
    assert found.position[1:] == pytest.approx(np.array([[0, 25.4, 0], [0, 50.8, 0]]), abs=1e-9)
    # The second frame is turned by 90 degrees and lies at 3,0,0: there the tool is at 0,-7,0.
    frames = "MSYS/0,0,0,1,0,0,0,1,0\nGOTO/10,0,0\nMSYS/3,0,0,0,1,0,-1,0,0\nINDIRV/1,0,0\n"
    found = program(f"{HEAD}{frames}TLON,GOFWD/(CIRCLE/0,0,0,7),ON,(PLANE/0,1,0,0)\n")
    assert found.position[-1] == pytest.approx([3, 7, 0], abs=1e-9)
    assert found.arc_centre[-1] == pytest.approx([3, 0, 0])
    assert found.arc_axis[-1] == pytest.approx([0, 0, 1])


@pytest.mark.parametrize("before", ["GOTO/1,2,3\n", "FROM/1,2,3\n"])
def test_a_part_surface_lasts_until_autops(before):
    text = f"{before}PSIS/(PLANE/0,0,1,9)\nAUTOPS\nGOTO/10,0,4\nINDIRV/0,1,0\n"
    found = program(f"{HEAD}{text}TLON,GOFWD/{CANON},ON,(PLANE/1,0,0,0)\n")
    assert found.position[-1] == pytest.approx([0, 10, 4], abs=1e-9)


def test_a_helix_of_arcmov_turns_and_rises_evenly():
    """450 degrees from 10,0,0 by 5 mm: a full turn ends 4 mm up, the rest at 0,10,5."""
    found = program(f"{START}ARCSLP/-5\nARCDAT/0,0,0,0,0,1,10\nARCMOV/CCLW,0,10,5,450\n")
    assert found.position[1:] == pytest.approx(np.array([[10, 0, 4], [0, 10, 5]]), abs=1e-9)
    length = np.hypot(10 * np.radians(450), 5)  # the helix rolled out
    parts = arc_length(found.position[:-1], found.position[1:], found.arc_centre[1:], found.arc_axis[1:])
    assert parts.sum() == pytest.approx(length)


@pytest.mark.parametrize("depth", [5, -5])
def test_a_helix_of_movarc_rises_to_its_end_point(depth):
    """As Fusion's post Mori APT writes it: the sign tells the sense once more, GOTO the height [Autodesk posts]."""
    movarc = "MOVARC/ CENTER, 0, 0, 0, AXIS, 0, 0, 1, RADIUS, 10\n"
    text = f"{START}ARCSLP/ {depth}\n{movarc}GOTO/ 0, 10, 5\n"
    found = program(f"{text}{movarc}GOTO/ -10, 0, 5\n")
    assert found.position[1:] == pytest.approx(np.array([[0, 10, 5], [-10, 0, 5]]))
    assert found.arc_axis[1:].tolist() == [[0, 0, 1]] * 2
    diagnostics = read(text.replace("10, 5", "10, 4"), "part.cl", ReadOptions("apt"))[1]
    assert [(d.code, d.found) for d in errors(diagnostics)] == [("L408", "it rises by 4 mm, ARCSLP gives 5 mm")]


def test_a_full_circle_of_arcmov():
    found = program(f"{START}ARCDAT/0,0,0,0,0,1,10\nARCMOV/CLW,10,0,0,360\n")
    assert np.degrees(turned(found)) == pytest.approx(360)
    assert found.arc_axis[-1] == pytest.approx([0, 0, -1])


@pytest.mark.parametrize("turn", [0.02, 0.5, 0.98, 1.0, 1.02, 2.5, 2.98, 3.0])
@pytest.mark.parametrize("way", [1, -1])
def test_the_pitch_of_a_helix_says_its_turns(turn, way):
    """The pitch has three decimals, so turns by pitch and turn by end point differ a little."""
    start, centre, axis = np.array([10.0, 0, 1]), np.zeros(3), np.array([0, 0, float(way)])
    end = arc_points(start, centre, axis, np.array(2 * np.pi * turn), np.array(way * 4.0 * turn))
    found = program(
        f"{HEAD}GOTO/{numbers(start)}\nHELICAL/0,0,0,0,{way},0,0,0,1,{4.001 if turn > 1 else 3.999},10,{numbers(end)}\n"
    )
    assert turned(found) == pytest.approx(2 * np.pi * turn, abs=1e-6)
    assert found.position[-1] == pytest.approx(end, abs=MICRON)


def test_a_cylinder_is_a_circle():
    plain = program(f"{START}CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\n", hand="right")
    same_arc(program(f"{START}CYLNDR/0,0,0,0,0,1,10\nGOTO/0,10,0\n", hand="right"), plain)


COMMENT = "$$ CIRCLE/0,0,0,0,0,1,10\n"
STEPS = "GOTO/8,6,0\nGOTO/0,10,0\n"  # 6, 8, 10: a right triangle


@pytest.mark.parametrize(
    "text, arcs",
    [
        (f"{COMMENT}{STEPS}", [1, 1]),
        (f"$$CYLNDR / 0, 0, 0, 0, 0, 1, 10\n{STEPS}", [1, 1]),
        (f"{COMMENT}GOTO/8,6,.01\nGOTO/0,10,.01\n", [0, 1]),  # a line to the circle, then along it
        (f"{COMMENT}GOTO/10,0,0\nGOTO/8,6,0\nGOTO/8,6,0\nGOTO/0,10,0\n", [0, 1, 0, 1]),  # what is repeated is no turn
        ("CIRCLE/0,0,0,0,0,1,10\nGOTO/10,0,0\n8,6,0\n8,6,0\n0,10,0\nGOTO/0,10,0\n", [0, 1, 0, 1, 0]),
        (f"{COMMENT}RAPID\n{STEPS}", [0, 0]),
        (f"{COMMENT}GOTO/8,6,0\nGOTO/8,5.99,0\nGOTO/8,6,0\nGOTO/0,10,0\n", [1, 0, 0, 0]),
        (f"$$ CIRCLE/0,0,0,0,0,1\n{STEPS}", [0, 0]),
        (f"$$ CIRCLE 0,0,0,0,0,1,10\n{STEPS}", [0, 0]),
        (f"FEDRAT/9 {COMMENT}{STEPS}", [0, 0]),
        (f"$$ CIRCLE/0,0,0,0,0,1,10 as drawn\n{STEPS}", [0, 0]),
        (f"{COMMENT}GOTO/8,6,0\n$$ CIRCLE/0,0,0,0,0,1,9\nGOTO/0,10,0\n", [1, 0]),
        (f"{COMMENT}CIRCLE/0,0,0,0,0,1,10\n{STEPS}", [1, 0]),
    ],
)
def test_how_far_a_circle_in_a_comment_reaches(text, arcs):
    found = program(START + text, hand="right")
    assert (found.kind[1:] == Kind.ARC).tolist() == [bool(arc) for arc in arcs]


def test_comments_of_other_dialects_are_comments():
    assert (program(START + COMMENT + STEPS, dialect="catia").kind[1:] == Kind.LINE).all()


@pytest.mark.parametrize("angle", ["0", "-90", "-180", "361"])
def test_an_angle_of_movarc_that_is_no_arc_is_refused(angle):
    """0 degrees were a full turn, and a sign was ignored."""
    end = {"-90": "0,-10,0", "-180": "-10,0,0"}.get(angle, "10,0,0")
    diagnostics = read(f"{START}MOVARC/0,0,0,0,0,1,10,ANGLE,{angle}\nGOTO/{end}\n", "part.cl", ReadOptions("catia"))[1]
    assert [fault.code for fault in errors(diagnostics)][:1] == ["L401"]
