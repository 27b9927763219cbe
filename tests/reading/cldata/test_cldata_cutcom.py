# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the points under CUTCOM are the contour or the centre, on contours made at random in every dialect.

The second opinion is a reader of a few lines here: the points of a file as they stand, or their lines moved sideways
and crossed again.
"""

import random
import re

import numpy as np
import pytest

from pkm_post.model import Kind
from pkm_post.model.diagnostics import errors
from pkm_post.reading.cldata import CONTOUR_DATA, DIALECTS, ReadOptions, read
from pkm_post.toolpath.compensation.compensate import compensate
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

MICRON = 1e-3
RADIUS = 5.0
SEEDS = range(12)

HEADS = {
    "nx": "TOOL PATH/P,TOOL,M\nTLDATA/MILL,10.0,0.0,75.0,0.0,0.0\nMSYS/0,0,0,1,0,0,0,1,0\nPAINT/PATH\nLOAD/TOOL,1\n",
    "creo": "$$*   Pro/CLfile  Version 8.0\n$$-> MFGNO / M\nLOADTL / 1\n$$-> CUTTER / 10.0\n",
    "catia": "$$ CATIA APT VERSION 1.0\n$$ OPERATION NAME : P\nCUTTER/10\nLOADTL/1\n",
    "solidworks": "UNIT/MM\nINSERT/M\nCUTTER/10.,0,5.,0,0,0,60.\nLOAD/TOOL,1\nCSI_SET_FLUTE_LENGTH/20.\n",
    "camplete": "MCS/1,0,0,0,1,0,0,0,1,0,0,0\nCSI_TOOL_PATH/P\nCUTTER/10\nLOADTL/1\n",
    "makino": "PPRINT/APTCL-SPEC,MAKINO-FF,1\nPPRINT/BEGIN-SECTION,DEFINE\nCUTTER/10\nLOAD/TOOL,1\n",
    "apt": "PARTNO P\nCUTTER/10\nLOADTL/1\n",
}
COMMENTS = {
    ("nx", "centre"): "$$ centerline data\n",
    ("nx", "contour"): "$$ contact contour data\n",
    ("creo", "centre"): "$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_CENTER\n",
    ("creo", "contour"): "$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_PROFILE\n",
}
"""What a file states about its points, by dialect."""


def pocket(seed):
    """Corners of a closed pocket, counterclockwise, on a circle of 40 mm; it turns by less than 90 degrees, (N, 2)."""
    chance = random.Random(seed)
    count = chance.randint(5, 9)
    steps = np.array([chance.uniform(0.8, 1.2) for _ in range(count)])
    angle = chance.uniform(0, 6) + np.cumsum(steps) * 2 * np.pi / steps.sum()
    return np.round(40 * np.stack([np.cos(angle), np.sin(angle)], axis=1), 4)


def written(dialect, corners, side, comment=""):
    """A file: from the middle to the first line of a pocket, round it, and back."""
    first = (corners[0] + corners[1]) / 2
    round_it = np.roll(corners, -1, axis=0)
    points = [first, *(round_it if side == "LEFT" else round_it[::-1]), first]
    goto = "".join(f"GOTO/{x:.4f},{y:.4f},-1.\n" for x, y in points)
    head = ("" if dialect == "solidworks" else "UNITS/MM\n") + HEADS[dialect] + comment
    begin = "RAPID\nGOTO/0,0,5.,0,0,1.\nFEDRAT/300.,MMPM\nGOTO/0,0,-1.\n"
    return f"{head}{begin}CUTCOM/{side}\n{goto}CUTCOM/OFF\nGOTO/0,0,-1.\nRAPID\nGOTO/0,0,5.\n"


def as_they_stand(text):
    """The points of a file."""
    return np.array([list(map(float, line.split(",")[:3])) for line in re.findall(r"GOTO/(.*)", text)])


def moved_inwards(corners, by):
    """Corners of a pocket whose lines are moved to the left of the direction of travel and crossed again."""
    ahead = np.roll(corners, -1, axis=0) - corners
    ahead /= np.hypot(*ahead.T)[:, None]
    normal = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    level = np.sum(corners * normal, axis=1) + by
    pairs = zip(np.roll(normal, 1, axis=0), normal, np.roll(level, 1), level, strict=True)
    return np.array([np.linalg.solve([one, other], [low, high]) for one, other, low, high in pairs])


def found(text, **options):
    program, diagnostics = read(text, "part.cl", ReadOptions(**options))
    assert not errors(diagnostics), [str(fault) for fault in diagnostics]
    moved, faults = compensate(program, OffsetOptions(), {})
    assert not errors(faults), [str(fault) for fault in faults]
    return program, moved, [fault.code for fault in diagnostics if fault.code != "L411"]


def codes(text, **options):
    program, diagnostics = read(text, "part.cl", ReadOptions(**options))
    assert (program is None) == bool(errors(diagnostics))
    return [fault.code for fault in diagnostics if fault.code != "L411"]


def assert_corners(moved, corners):
    """Every corner is a point of the path, and no point of the cut lies elsewhere but on the lines between them."""
    path = moved.position[:, :2]
    for corner in corners:
        assert np.hypot(*(path - corner).T).min() < MICRON


SOURCES = [(dialect, points, "comment") for dialect, points in COMMENTS]
SOURCES += [(dialect, points, "option") for dialect in DIALECTS for points in CONTOUR_DATA]


@pytest.mark.slow
@pytest.mark.parametrize("dialect, points, source", SOURCES)
def test_pockets_are_cut_where_both_readings_have_them(dialect, points, source):
    options = {"contour_data": points} if source == "option" else {}
    comment = COMMENTS[dialect, points] if source == "comment" else ""
    for seed in SEEDS:
        side = ("LEFT", "RIGHT")[seed % 2]
        corners = pocket(seed)
        text = written(dialect, corners, side, comment)
        program, moved, diagnostics = found(text, **options)
        assert diagnostics == [] and DIALECTS[dialect].title
        if points == "centre":
            assert moved.position == pytest.approx(as_they_stand(text), abs=1e-9)
        else:
            assert np.abs(program.side_offset).max() == RADIUS
            assert_corners(moved, moved_inwards(corners, RADIUS))
        (line,) = program.reading
        assert {"centre": "centre of the tool", "contour": "contour of the part"}[points] in line


@pytest.mark.slow
@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("wear", [0.25, -0.25])
def test_wear_alone_offsets_the_centre(dialect, wear):
    for seed in SEEDS:
        side, corners = ("LEFT", "RIGHT")[seed % 2], pocket(seed)
        text = written(dialect, corners, side)
        _, moved, _ = found(text, contour_data="centre", wear={1: wear})
        assert_corners(moved, moved_inwards(corners, wear))
        _, moved, _ = found(text, contour_data="contour", wear={1: wear})
        assert_corners(moved, moved_inwards(corners, RADIUS + wear))


@pytest.mark.parametrize("dialect", DIALECTS)
def test_a_file_that_does_not_say_is_refused(dialect):
    for seed in SEEDS:
        assert codes(written(dialect, pocket(seed), "LEFT")) == ["L429"]


def test_the_header_of_one_tool_path_says_nothing_of_the_next():
    one = written("nx", pocket(1), "LEFT", COMMENTS["nx", "centre"]) + "END-OF-PATH\n"
    other = written("nx", pocket(2), "LEFT").removeprefix("UNITS/MM\n")
    assert codes(one + other) == ["L429"]
    both = one + other.replace("PAINT/PATH\n", "$$ contact contour data\n")
    program, moved, _ = found(both)
    assert [line.split(", ")[0].split("points are ")[1] for line in program.reading] == [
        "the centre of the tool",
        "the contour of the part",
    ]
    count = len(as_they_stand(one))
    assert moved.position[:count] == pytest.approx(as_they_stand(one), abs=1e-9)
    assert_corners(moved, moved_inwards(pocket(2), RADIUS))


BLANKS = [
    "$$centerline data",
    "$$   CENTERLINE  DATA",
    " $$ Centerline Data ",
    "$$ center line data",
    "$$ centreline data",
]


@pytest.mark.parametrize("header", BLANKS)
def test_blanks_and_capitals_of_the_header_do_not_matter(header):
    assert found(written("nx", pocket(3), "LEFT", header + "\n"))[2] == []


def test_a_header_with_another_letter_says_nothing():
    chance = random.Random(7)
    for header in ("$$ centerline data", "$$ contact contour data"):
        for _ in range(60):
            place = chance.choice([i for i, letter in enumerate(header) if letter.isalpha()])
            letter = chance.choice("bjkqvwxz")
            spoiled = header[:place] + letter + header[place + 1 :] + "\n"
            assert codes(written("nx", pocket(3), "LEFT", spoiled)) == ["L429"], spoiled


def led(size, turn="LEFT", away=False, dialect="solidworks", axis=(0, 0, 1.0), frame=None):
    """A straight cut with arcs of one radius that lead on and off, on the side of the tool or on the other."""
    side = 1.0 if (turn == "LEFT") != away else -1.0
    y = side * size
    rows = [(-30 - size, 3 * y), (-size, y), (0.0, 0.0), (60.0, 0.0), (60 + size, y), (90 + size, 3 * y)]
    corners = [np.array([*row, -1.0]) for row in rows]
    centres = {2: np.array([0.0, y, -1.0]), 4: np.array([60.0, y, -1.0])}
    turned = np.eye(3) if frame is None else frame
    sense = 1.0 if side > 0 else -1.0
    body = []
    for index, point in enumerate(corners):
        if index in centres:
            body.append("CIRCLE/" + numbers(turned @ centres[index], turned @ np.array([0, 0, sense])))
        if index == 1:
            body.append(f"CUTCOM/{turn}")
        if index == 5:
            body.append("CUTCOM/OFF")
        body.append("GOTO/" + numbers(turned @ point, turned @ np.array(axis)))
    head = ("" if dialect == "solidworks" else "UNITS/MM\n") + HEADS[dialect]
    return head + "FEDRAT/300.,MMPM\n" + "\n".join(body) + "\n"


def numbers(*vectors):
    return ",".join(f"{value:.9f}" for vector in vectors for value in vector)


@pytest.mark.parametrize("turn", ["LEFT", "RIGHT"])
def test_arcs_that_no_such_tool_can_follow_show_the_centre(turn):
    chance = random.Random(11)
    for size in [0.5, 1.0, 4.98, 5.0, 5.02, *(chance.uniform(0.2, 15) for _ in range(20))]:
        text = led(size, turn)
        if size < RADIUS - 0.01:
            program, moved, diagnostics = found(text)
            assert diagnostics == ["L430"]
            assert moved.position == pytest.approx(as_they_stand(text), abs=1e-8)
            assert "points are the centre of the tool, since 2 arcs bend towards it" in program.reading[0]
        else:
            assert codes(text) == ["L429"], size


@pytest.mark.parametrize("dialect", sorted({*DIALECTS} - {"solidworks"}))
def test_elsewhere_such_arcs_may_be_a_tool_that_is_too_large(dialect):
    _, diagnostics = read(led(1.0, dialect=dialect), "part.cl", ReadOptions(hand="right"))
    (fault,) = errors(diagnostics)
    assert fault.code == "L429"
    shown = "2 arcs bend towards it and are tighter than its radius of 5 mm, down to 1 mm in line"
    assert re.search(rf"; {shown} \d+, as the centre may$", fault.found)


def test_arcs_that_no_centre_goes_by_speak_against_it():
    (fault,) = errors(read(led(1.0, away=True), "part.cl")[1])
    assert re.search(r"2 arcs bend away .* down to 1 mm in line \d+, as a contour may$", fault.found)
    both = led(1.0) + "\n".join(led(1.0, away=True).splitlines()[6:])
    (fault,) = errors(read(both, "part.cl")[1])
    assert "as the centre may; 2 arcs bend away" in fault.found


def test_another_tool_shows_nothing_of_this_one():
    other = led(9.0).replace("LOAD/TOOL,1", "LOAD/TOOL,2").removeprefix("UNIT/MM\n")
    _, diagnostics = read(led(1.0) + other, "part.cl")
    (fault,) = errors(diagnostics)
    assert (fault.code, fault.found) == ("L429", "CUTCOM in line 23 with T2")


def test_another_cutter_of_this_number_shows_nothing_of_it_either():
    other = led(9.0).replace("CUTTER/10.,0,5.", "CUTTER/12.,0,6.").removeprefix("UNIT/MM\n")
    assert codes(led(1.0) + other) == ["L430", "L429"]


def rotation(seed):
    """A rotation of space."""
    matrix, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return matrix * np.sign(np.linalg.det(matrix))


@pytest.mark.slow
@pytest.mark.parametrize("points", CONTOUR_DATA)
@pytest.mark.parametrize("turn", ["LEFT", "RIGHT"])
def test_left_and_right_are_seen_from_the_tool_whichever_way_it_points(points, turn):
    straight = found(led(12.0, turn), contour_data=points, wear={1: 0.5})[1]
    for seed in range(12):
        matrix = rotation(seed)
        moved = found(led(12.0, turn, frame=matrix), contour_data=points, wear={1: 0.5})[1]
        assert moved.position == pytest.approx(straight.position @ matrix.T, abs=1e-5)
        assert codes(led(1.0, turn, frame=matrix)) == ["L430"]
        assert codes(led(12.0, turn, frame=matrix)) == ["L429"]


def rounded(corners, radius):
    """Centres of the fillets of a pocket, and where each begins and ends, (N, 2) each."""
    centres = moved_inwards(corners, radius)
    ahead = np.roll(corners, -1, axis=0) - corners
    outwards = np.stack([ahead[:, 1], -ahead[:, 0]], axis=1) / np.hypot(*ahead.T)[:, None]
    return centres, centres + radius * np.roll(outwards, 1, axis=0), centres + radius * outwards


def written_rounded(dialect, corners, radius, comment=""):
    """A file: a pocket with fillets, counterclockwise, with the axis that the dialect gives to such arcs."""
    centres, begins, ends = rounded(corners, radius)
    sense = dict.fromkeys(("nx", "makino", "camplete"), -1).get(dialect, 1)
    first = (ends[0] + begins[1]) / 2
    body = [f"GOTO/{first[0]:.6f},{first[1]:.6f},-1"]
    for centre, begin, end in zip(*(np.roll(each, -1, axis=0) for each in (centres, begins, ends)), strict=True):
        size = "" if dialect == "solidworks" else f",{radius}"
        body += [
            f"GOTO/{begin[0]:.6f},{begin[1]:.6f},-1",
            f"CIRCLE/{centre[0]:.6f},{centre[1]:.6f},-1,0,0,{sense}{size}",
        ]
        body += [f"GOTO/{end[0]:.6f},{end[1]:.6f},-1"]
    head = ("" if dialect == "solidworks" else "UNITS/MM\n") + HEADS[dialect] + comment
    body = "\n".join([*body, body[0]])
    return f"{head}FEDRAT/300.,MMPM\nGOTO/0,0,-1\nCUTCOM/LEFT\n{body}\nCUTCOM/OFF\nGOTO/0,0,-1\n"


@pytest.mark.slow
@pytest.mark.parametrize("dialect, points, source", SOURCES)
def test_fillets_are_those_of_the_reading(dialect, points, source):
    options = {"contour_data": points} if source == "option" else {}
    comment = COMMENTS[dialect, points] if source == "comment" else ""
    for seed in SEEDS:
        corners, radius = pocket(seed), random.Random(seed).choice([6.0, 7.5, 9.0])
        _, moved, _ = found(written_rounded(dialect, corners, radius, comment), **options)
        left = radius - RADIUS if points == "contour" else radius
        centres, begins, ends = (np.roll(each, -1, axis=0) for each in rounded(corners, radius))
        arcs = np.flatnonzero(moved.kind == Kind.ARC)
        assert moved.arc_centre[arcs, :2] == pytest.approx(centres, abs=1e-5)
        assert moved.position[arcs - 1, :2] == pytest.approx(centres + (begins - centres) * left / radius, abs=1e-5)
        assert moved.position[arcs, :2] == pytest.approx(centres + (ends - centres) * left / radius, abs=1e-5)
        assert moved.arc_axis[arcs, 2] == pytest.approx(1)


def test_fillets_tighter_than_the_tool_show_the_centre_in_camworks_alone():
    for seed in SEEDS:
        corners = pocket(seed)
        assert codes(written_rounded("solidworks", corners, 3.0)) == ["L430"]
        assert codes(written_rounded("solidworks", corners, 6.0)) == ["L429"]
        assert codes(written_rounded("apt", corners, 3.0)) == ["L429"]


@pytest.mark.parametrize("wear", [0.25, -0.25])
@pytest.mark.parametrize("side", ["LEFT", "RIGHT"])
def test_wear_round_sharp_corners(side, wear):
    corners = np.array([[-30.0, -20.0], [30.0, -20.0], [0.0, 35.0]])
    text = written("apt", corners, side)
    program, moved, _ = found(text, contour_data="centre", wear={1: wear})
    if wear > 0:
        assert_corners(moved, moved_inwards(corners, wear))
    else:  # outer corners of more than a right angle are cut off: S3 and S4 of the joint go on by the wear
        assert len(moved) > len(program)
        for corner in corners:
            near = np.hypot(*(moved.position[:, :2] - corner).T)
            assert np.sort(near)[:4] == pytest.approx(0.25 * np.sqrt([1, 1, 2, 2]), abs=MICRON)


def lapped(side, gap):
    """A cut along a slot and back, offset by a gap, the tool between both cuts; it ends on its own beginning."""
    sign = -1.0 if side == "LEFT" else 1.0
    y = -sign * gap
    points = [(0, 0), (60, 0), (60, y), (-5, y), (-5, 0), (3, 0)]
    goto = "".join(f"GOTO/{x},{place:.4f},-1\n" for x, place in points)
    head = "UNITS/MM\nCUTTER/10\nLOADTL/1\nFEDRAT/300,MMPM\n"
    return f"{head}GOTO/0,{-2 * sign},-1\nCUTCOM/{side}\n{goto}CUTCOM/OFF\nGOTO/3,{-2 * sign},-1\n"


@pytest.mark.parametrize("side", ["LEFT", "RIGHT"])
def test_a_larger_tool_may_cut_the_other_side_and_a_smaller_one_may_not(side):
    text = lapped(side, 8.0)
    for wear, faulty in ((0.1, False), (-0.1, False), (3.9, False), (4.1, True), (-4.1, False)):
        program, _ = read(text, "part.cl", ReadOptions(contour_data="centre", wear={1: wear}))
        moved, diagnostics = compensate(program, OffsetOptions(), {})
        assert (moved is None) == faulty, (wear, [str(fault) for fault in diagnostics])
        assert program.smaller_tool.any() == (wear < 0)
    program, _ = read(text, "part.cl", ReadOptions(contour_data="contour", wear={1: -0.1}))
    assert not program.smaller_tool.any()


@pytest.mark.parametrize(
    "items", ["LEFT,OSETNO,5", "LEFT,XYPLAN,OSETNO,5", "LEFT,PLANE,XYPLAN", "LEFT,ADJUST,5", "LEFT,5"]
)
def test_registers_of_the_control_say_nothing_of_the_path(items):
    text = written("nx", pocket(4), "LEFT", COMMENTS["nx", "contour"])
    _, moved, diagnostics = found(text.replace("CUTCOM/LEFT", f"CUTCOM/{items}"))
    assert diagnostics == []
    assert_corners(moved, moved_inwards(pocket(4), RADIUS))


def test_the_diameter_that_the_user_gives_goes_before_that_of_the_file():
    from pkm_post.model import Tool

    text = written("nx", pocket(5), "LEFT", COMMENTS["nx", "contour"])
    _, moved, _ = found(text, tools={1: Tool(1, "", 6.0, 0.0, 0.0)})
    assert_corners(moved, moved_inwards(pocket(5), 3.0))


def test_wear_of_a_tool_without_cutcom_is_reported():
    text = written("nx", pocket(6), "LEFT", COMMENTS["nx", "centre"])
    assert codes(text, wear={2: 0.1}) == ["L432"]
    assert codes(text.replace("CUTCOM/LEFT\n", ""), wear={1: 0.1}) == ["L432"]


def test_centre_data_without_wear_keeps_its_arcs():
    text = led(1.0)
    program, moved, _ = found(text)
    assert np.count_nonzero(moved.kind == Kind.ARC) == np.count_nonzero(program.kind == Kind.ARC) == 2


@pytest.mark.parametrize("wrong", [{"contour_data": "center"}, {"wear": {1: float("nan")}}])
def test_options_that_are_none(wrong):
    with pytest.raises(ValueError, match="expected"):
        ReadOptions(**wrong)


def offset_in(frame, words, axis="0,0,1"):
    """Offset and plane of a contour under CUTCOM in a frame; or the faults."""
    text = (
        f"UNITS/MM\nCUTTER/10\nLOADTL/1,LENGTH,90\nFEDRAT/99\n{frame}GOTO/0,0,0,{axis}\n"
        f"CUTCOM/{words}\nGOTO/1,2,3\nCUTCOM/OFF\nGOTO/0,0,0\nFINI\n"
    )
    program, diagnostics = read(text, "part.cl", ReadOptions(contour_data="contour", dialect="apt"))
    if program is None:
        return [fault.code for fault in errors(diagnostics)]
    return float(program.side_offset[1]), int(program.plane[1])


TURNED = "TRACUT/0.8,-0.6,0,0,0.6,0.8,0,0,0,0,1,0\n"
QUARTER = "TRACUT/0,-1,0,0,1,0,0,0,0,0,1,0\n"


@pytest.mark.parametrize(
    ("frame", "words", "axis", "expected"),
    [
        (TURNED, "LEFT,XYPLAN", "0,0,1", (5, 2)),
        (TURNED, "LEFT,ZXPLAN", "0,0,1", ["L401"]),
        (TURNED, "RIGHT,YZPLAN", "0,0,1", ["L401"]),
        (TURNED, "LEFT,ZXPLAN", "0,1,0", (5, 1)),  # the plane normal to the tool
        (QUARTER, "LEFT,ZXPLAN", "0,0,1", (-5, 0)),
        (QUARTER, "LEFT,YZPLAN", "0,0,1", (5, 1)),
        ("", "LEFT", "0,0,-1", (-5, 2)),
        ("", "LEFT,XYPLAN", "0,0,-1", (-5, 2)),
        ("", "LEFT,ZXPLAN", "0,0,-1", (5, 1)),
    ],
)
def test_named_planes_turn_with_the_frame_and_are_seen_from_the_holder(frame, words, axis, expected):
    assert offset_in(frame, words, axis) == expected


@pytest.mark.parametrize(
    "words", ["OFF,LEFT", "LEFT,OFF", "ON,OFF", "LEFT,XYPLAN,YZPLAN", "LEFT,RIGHT", "LEFT,2.5", "LEFT,-1", "LEFT,3,4"]
)
def test_words_that_contradict_each_other_are_refused(words):
    """OFF,LEFT was LEFT."""
    text = f"{HEADS['apt']}UNITS/MM\nFEDRAT/100\nGOTO/0,0,0\nCUTCOM/{words}\nGOTO/9,0,0\nCUTCOM/OFF\nGOTO/9,9,0\nFINI\n"
    found, diagnostics = read(text, "part.apt", ReadOptions(contour_data="contour"))
    assert found is None
    assert [(fault.code, fault.place.line) for fault in errors(diagnostics)] == [("L401", 7)]
