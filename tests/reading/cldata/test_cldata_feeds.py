# SPDX-License-Identifier: LGPL-2.1-or-later
"""FEDRAT, SPINDL, RAPID and CUTCOM in the forms of post-processor words: modes, limits, and times of statements.

Sources: [NCCS PostWorks], `fedrat.f`, `pstwqz.f` and `cutcom.f`; ICAM Technologies, help of CAM-POST: SPINDL, CUTCOM.
"""

import math

import numpy as np
import pytest

from pkm_post.geometry import move_lengths
from pkm_post.model import EventKind, Kind
from pkm_post.model.diagnostics import errors
from pkm_post.reading.cldata import ReadOptions, read

HEAD = "UNITS/MM\nLOADTL/1,LENGTH,100\nCUTTER/10\nFEDRAT/600,MMPM\nGOTO/0,0,0\n"


def program(text, **options):
    found, diagnostics = read(text, "part.cl", ReadOptions(**options))
    assert not errors(diagnostics), [str(fault) for fault in diagnostics]
    return found


def codes(text, **options):
    found, diagnostics = read(text, "part.cl", ReadOptions(**options))
    assert found is None
    return [(fault.code, fault.place.line) for fault in errors(diagnostics)]


def speeds(text):
    return [(event.row, event.value) for event in program(text).events if event.kind is EventKind.SPINDLE]


@pytest.mark.parametrize(
    "statements, feed",
    [
        ("FEDRAT/INVERS\nFEDRAT/4", 2),  # 30 mm in a quarter of a minute
        ("FEDRAT/INVERS,5\nFEDRAT/MMPM\nFEDRAT/60", 1),
        ("FEDRAT/INVERS,5\nFEDRAT/INVERS,OFF\nFEDRAT/60", 1),
        ("FEDRAT/INVERS,AUTO\nFEDRAT/60", 1),
        ("FEDRAT/MMPR\nFEDRAT/.1", 2),
        ("FEDRAT/IPM\nFEDRAT/6", 2.54),
        ("FEDRAT/IPM", 10),  # the same mode: the feed stays
    ],
)
def test_a_unit_alone_is_that_of_the_next_values(statements, feed):
    assert program(f"{HEAD}SPINDL/1200,CLW\n{statements}\nGOTO/30,0,0\n").feed[-1] == pytest.approx(feed)


def test_a_turn_in_place_takes_the_time_of_its_statement():
    text = f"{HEAD}FEDRAT/INVERS,5\nGOTO/0,0,0,0,1,0\nGOTO/0,0,0,0,1,1\nGOTO/6,0,0,0,1,0\n"
    assert program(text).feed[-3:] == pytest.approx([90 * 5 / 60, 45 * 5 / 60, 6 * 5 / 60])  # degrees/s, and mm/s


@pytest.mark.parametrize("statements", ["FEDRAT/INVERS", "FEDRAT/MMPR", "FEDRAT/INVERS,5\nFEDRAT/INVERS,OFF"])
def test_another_mode_without_a_value_has_no_feed(statements):
    text = f"{HEAD}SPINDL/1200,CLW\n{statements}\nGOTO/30,0,0\n"
    assert codes(text) == [("L407", text.count("\n"))]


def test_a_feed_per_turn_needs_a_speed():
    text = "UNITS/MM\nLOADTL/1,LENGTH,100\nFEDRAT/.1,MMPR\nGOTO/0,0,0\nGOTO/1,0,0\nSPINDL/1200,CLW\nGOTO/2,0,0\n"
    assert codes(text) == [("L403", 5)]
    assert program(text.replace("GOTO/1,0,0\n", "")).feed[-1] == pytest.approx(2)


def seconds(found, line):
    """Time of the rows of a line at their feeds."""
    before = np.vstack([found.position[:1], found.position[:-1]])
    length = move_lengths(before, found.position, found.kind == Kind.ARC, found.arc_centre, found.arc_axis)
    mine = found.line == line
    return float((length[mine] / found.feed[mine]).sum())


@pytest.mark.parametrize("times", ["", ",.01,.5,10,0,TIMES,3"])
def test_inverse_time_is_that_of_the_whole_helix(times):
    text = f"{HEAD}GOTO/10,0,0\nFEDRAT/INVERS,5\nCIRCLE/0,0,0,0,0,1,10{times}\nGOTO/10,0,6\n"
    assert seconds(program(text, hand="right"), 9) == pytest.approx(60 / 5)


def test_inverse_time_is_that_between_the_points_of_a_curve():
    """The parabola x = 2t, y = 2t(1-t) * 20 of three control points, with two points on it."""
    curve = "MOVNRB/M3AXIS\nMOVNRB/ON,3,6,0,3,30\nMOVNRB/1,0,0,0,1,1,1\nMOVNRB/2,0,0,0,10,20,0,20,0,0\nMOVNRB/NEXT\n"
    text = f"{HEAD}FEDRAT/INVERS,5\n{curve}GOTO/10,10,0\nGOTO/20,0,0\nMOVNRB/OFF\n"
    found = program(text, dialect="creo")
    lines = [12, 13]
    assert [int((found.line == line).sum()) > 10 for line in lines] == [True, True]
    assert [seconds(found, line) for line in lines] == pytest.approx([60 / 5, 60 / 5])


@pytest.mark.parametrize(
    "statement, speed",
    [
        ("SPINDL/ORIENT", 0), ("SPINDL/ORIENT,90", 0), ("SPINDL/OFF", 0), ("SPINDL/LOCK", 0),
        ("SPINDL/MAXRPM,3000", 500), ("SPINDL/RANGE,2", 500), ("SPINDL/CLW,AUTO,900", 900),
        ("SPINDL/314.159265358979,SMM,MAXRPM,1000", 1000), ("SPINDL/MAXRPM,1000\nSPINDL/314.159265358979,SMM", 1000),
        ("SPINDL/314.159265358979,SMM", 10000), ("SPINDL/314.159265358979,SMM,RADIUS,50", 1000),
    ],
)  # fmt: skip
def test_angles_limits_and_ranges_are_no_speeds(statement, speed):
    found = speeds(f"{HEAD}SPINDL/500,CLW\nGOTO/1,0,0\n{statement}\nGOTO/2,0,0\n")
    assert found[-1][1] == pytest.approx(speed)


@pytest.mark.parametrize(
    ("again", "speed"), [("ON", -1000), ("500", -500), ("ON,CLW", 1000), ("500,CLW", 500), ("RPM,500", -500)]
)
def test_the_spindle_starts_again_in_its_last_sense(again, speed):
    text = f"{HEAD}SPINDL/1000,CCLW\nGOTO/1,0,0\nSPINDL/OFF\nGOTO/2,0,0\nSPINDL/{again}\nGOTO/3,0,0\nFINI\n"
    assert [value for _, value in speeds(text)] == [-1000, 0, speed]


@pytest.mark.parametrize(
    ("statement", "code"),
    [
        ("DELAY/10,REV", "L403"),
        ("FEDRAT/.1,MMPR", "L403"),
        ("CYCLE/DRILL,FEDTO,-2,RAPTO,1,MMPR,.1", "L412"),
        ("CYCLE/DRILL,FEDTO,-2,RAPTO,1,DWELL,REV,3", "L412"),
    ],
)
def test_turns_of_a_stopped_spindle_are_refused(statement, code):
    stopped = f"{HEAD}SPINDL/1000,CLW\nGOTO/1,0,0\nSPINDL/OFF\n{statement}\n"
    assert [found for found, _ in codes(f"{stopped}GOTO/5,0,0\nFINI\n", dialect="nx")] == [code]
    if code == "L412" or "FEDRAT" in statement:
        program(f"{stopped}SPINDL/ON\nGOTO/5,0,0\nFINI\n", dialect="nx")


@pytest.mark.parametrize(("dialect", "coolants"), [("apt", [2, 0, 2, 1, 0, 1]), ("nx", [2, 0, 1, 1, 0, 1])])
def test_coolant_on_is_the_last_one_or_flood_with_nx(dialect, coolants):
    words = "".join(f"COOLNT/{word}\nGODLTA/1,0,0\n" for word in ("MIST", "OFF", "ON", "FLOOD", "OFF", "ON"))
    events = program(f"{HEAD}{words}FINI\n", dialect=dialect).events
    assert [event.value for event in events if event.kind is EventKind.COOLANT] == coolants


@pytest.mark.parametrize("motion", ["GOTO/1,2,3", "GODLTA/1,2,3", "RAPID,GOTO/1,2,3"])
@pytest.mark.parametrize("word", ["END", "REWIND"])
def test_no_motion_follows_the_end_of_the_program(word, motion):
    assert codes(f"{HEAD}{word}\n{motion}\nFINI\n") == [("L401", 7)]
    ended = program(f"{HEAD}{motion}\n{word}\nFINI\nGOTO/9,9,9\n")
    assert ended.position[1:].tolist() == [[1, 2, 3]]
    on = program(f"{HEAD}SPINDL/500,CLW\nCOOLNT/MIST\n{motion}\n{word}\nFINI\n")
    assert [(each.kind, each.value) for each in on.events if each.row == len(on)] == [
        (EventKind.SPINDLE, 0.0),
        (EventKind.COOLANT, 0.0),
    ]


@pytest.mark.parametrize("statement", ["SPINDL/500,CLW", "COOLNT/MIST", "LOADTL/2"])
def test_nothing_begins_after_the_end_of_the_program(statement):
    assert codes(f"{HEAD}GOTO/1,2,3\nEND\n{statement}\nFINI\n") == [("L401", 8)]
    program(f"{HEAD}GOTO/1,2,3\nEND\nSPINDL/OFF\nCOOLNT/OFF\nSTOP\nREWIND\nFINI\n")


@pytest.mark.parametrize("words", ["500,OFF", "ON,OFF", "500,RPM,SFM", "10,SFM,SMM", "CLW,CCLW,500"])
def test_speeds_that_contradict_themselves_are_refused(words):
    assert codes(f"{HEAD}SPINDL/{words}\nGOTO/1,0,0\nFINI\n") == [("L402", 6)]


@pytest.mark.parametrize(("words", "coolant"), [("ON,MIST", 2), ("MIST,ON", 2), ("FLOOD,HIGH", 1), ("THRU,70", 1)])
def test_on_beside_a_coolant_is_that_coolant(words, coolant):
    events = program(f"{HEAD}COOLNT/FLOOD\nGOTO/1,0,0\nCOOLNT/{words}\nGOTO/2,0,0\nFINI\n").events
    assert [event.value for event in events if event.kind is EventKind.COOLANT] == [1, coolant]


@pytest.mark.parametrize("words", ["MIST,OFF", "OFF,MIST", "FLOOD,MIST", "ON,OFF"])
def test_one_coolant_of_several_is_refused(words):
    """MIST,OFF was mist on."""
    assert codes(f"{HEAD}COOLNT/{words}\nGOTO/1,0,0\nFINI\n") == [("L402", 6)]


@pytest.mark.parametrize("words", ["LOCK,ON", "LOCK,OFF"])
def test_a_lock_of_spindle_or_override_is_refused(words):
    assert codes(f"{HEAD}SPINDL/{words}\nGOTO/1,0,0\n") == [("L402", 6)]


def test_a_surface_speed_is_that_of_the_cutter_it_is_used_with():
    """100 m/min over pi * 2 mm, where CUTTER stands behind SPINDL; a later cutter alone keeps the speed in 1/min."""
    change = "LOADTL/2,LENGTH,100\nSPINDL/100,SMM,CCLW\nFEDRAT/.1,MMPR\nCUTTER/2\n"
    text = f"{HEAD}{change}GOTO/1,0,0\nCUTTER/4\nGOTO/2,0,0\n"
    turns = 100_000 / (math.pi * 2)
    assert speeds(text) == [(1, pytest.approx(-turns))]
    assert program(text).feed[1:] == pytest.approx([0.1 * turns / 60] * 2)
    assert codes("UNITS/MM\nLOADTL/2\nSPINDL/100,SMM\nGOTO/1,0,0\nGOTO/2,0,0\n") == [("L403", 3)]


@pytest.mark.parametrize("again", ["ON", "CLW"])
def test_the_last_surface_speed_of_another_tool_is_refused(again):
    """A control may keep its turns, a post compute new ones; before any motion it is that of the next cutter."""
    change = f"LOADTL/2\nSPINDL/{again}\nCUTTER/4\n"
    assert codes(f"{HEAD}CUTTER/2\nSPINDL/100,SMM,CLW\nGOTO/1,0,0\n{change}GOTO/2,0,0\nFINI\n") == [("L403", 10)]
    turns = 100_000 / math.pi
    found = speeds(f"{HEAD}CUTTER/2\nSPINDL/100,SMM,CLW\n{change}GOTO/2,0,0\nFINI\n")
    assert [value for _, value in found][-1] == pytest.approx(turns / 4)
    same = speeds(f"{HEAD}CUTTER/2\nSPINDL/100,SMM,CLW\nGOTO/1,0,0\nSPINDL/OFF\nSPINDL/{again}\nGOTO/2,0,0\nFINI\n")
    assert [value for _, value in same] == pytest.approx([turns / 2, 0, turns / 2])


@pytest.mark.parametrize("word", ["RPM", "SMM", "SFM,CLW"])
def test_a_unit_of_speed_without_a_speed_is_refused(word):
    assert codes(f"{HEAD}SPINDL/500,CLW\nGOTO/1,0,0\nSPINDL/{word}\nGOTO/2,0,0\n") == [("L402", 8)]


@pytest.mark.parametrize("words", ["/ON", "/OFF", "/XAXIS", "/MODIFY,ON"])
def test_rapid_with_words_is_refused(words):
    assert codes(f"{HEAD}RAPID{words}\nGOTO/1,0,0\n") == [("L401", 6)]


def test_rapid_with_a_bare_slash_is_rapid():
    assert program(f"{HEAD}RAPID/\nGOTO/1,0,0\n").kind[-1] == Kind.RAPID


OFFSETS = [
    ("CUTCOM/LEFT", "CUTCOM/OFF", "CUTCOM/ON", [5, 0, 5]),
    ("CUTCOM/RIGHT,XYPLAN", "CUTCOM/OFF", "CUTCOM/ON", [-5, 0, -5]),
    ("CUTCOM/LEFT", "CUTCOM/ADJUST,OFF", "CUTCOM/OFF", [5, 5, 0]),
    ("CUTCOM/LEFT", "CUTCOM/OFF,LENGTH", "CUTCOM/OFF", [5, 5, 0]),
    ("CUTCOM/LEFT", "CUTCOM/OFF", "CUTCOM/ON,LENGTH,2", [5, 0, 0]),
    ("CUTCOM/ON\nCUTCOM/LEFT", "CUTCOM/ON", "CUTCOM/OFF", [5, 5, 0]),
]


@pytest.mark.parametrize("first, second, third, offsets", OFFSETS)
def test_cutcom_on_and_off_are_those_of_the_side(first, second, third, offsets):
    text = f"{HEAD}{first}\nGOTO/9,0,0\n{second}\nGOTO/19,0,0\n{third}\nGOTO/29,0,0\n"
    assert program(text, contour_data="contour").side_offset[1:].tolist() == offsets


@pytest.mark.parametrize("before, offsets", [("", [5, 2, 3, 0]), ("GOTO/4,0,0\n", [5, 5, 2, 3, 0])])
def test_the_offset_is_that_of_the_cutter_in_use(before, offsets):
    """A smaller cutter used to keep the radius of the one that CUTCOM was written for."""
    change = f"CUTCOM/LEFT\nGOTO/2,0,0\n{before}LOADTL/2\nCUTTER/4\nGOTO/9,0,0\nCUTTER/6\nGOTO/19,0,0\nCUTCOM/OFF\n"
    found = program(f"{HEAD}{change}CUTTER/8\nGOTO/29,0,0\n", contour_data="contour")
    assert found.side_offset[1:].tolist() == offsets
    worn = program(f"{HEAD}{change}GOTO/29,0,0\n", contour_data="centre", wear={2: -0.1})
    assert worn.side_offset[-3:] == pytest.approx([-0.1, -0.1, 0])


def test_a_cutter_may_be_written_behind_its_cutcom():
    text = f"{HEAD}LOADTL/2\nCUTCOM/RIGHT\nCUTTER/4\nGOTO/9,0,0\n"
    assert program(text, contour_data="contour").side_offset[1:].tolist() == [-2]
    text = "UNITS/MM\nLOADTL/2,LENGTH,100\nCUTCOM/LEFT\nCUTTER/4\nFEDRAT/9\nFROM/0,0,0\nGOTO/9,0,0\n"
    assert program(text, contour_data="contour").side_offset.tolist() == [2, 2]


def test_cutcom_on_before_any_side_is_refused():
    assert codes(f"{HEAD}CUTCOM/ON\nGOTO/9,0,0\n", contour_data="contour") == [("L401", 6)]


@pytest.mark.parametrize("y, code", [("-0.0001", []), ("0", []), ("0.0001", [("L408", 7)])])
def test_a_circle_that_ends_just_behind_its_start_is_a_full_turn_or_refused(y, code):
    """Ends of files with four decimals: where the rounding leaves no turn, a full one may be meant."""
    text = f"{HEAD}GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/10,{y},0\n"
    if code:
        assert codes(text, hand="right") == code
    else:
        found = program(text, hand="right")
        assert seconds(found, 8) == pytest.approx(20 * math.pi / 10, rel=1e-4)


@pytest.mark.parametrize("head", ["RAPID,", "rapid , ", "N10,RAPID,"])
def test_rapid_may_stand_before_its_motion_in_one_statement(head):
    """PERSONAL APT, sample of milling: RAPID,GODLTA/3,200 and RAPID,GOTO/0,0,3."""
    found = program(f"{HEAD}{head}GOTO/5,0,0\nGOTO/6,0,0\n{head}GODLTA/1,0,0\nGODLTA/1,0,0\n")
    assert found.position[:, 0].tolist() == [0, 5, 6, 7, 8]
    assert found.kind.tolist() == [Kind.RAPID, Kind.RAPID, Kind.LINE, Kind.RAPID, Kind.LINE]


@pytest.mark.parametrize(
    "statement",
    [
        "TLLFT,GORGT/1,2",
        "TLON,GOBACK/1",
        "GO,TO/5",
        "GOTO,RAPID/5,0,0",
        "TLOFPS,TLLFT,GOFWD/1",
        "RAPID,CIRCLE/0,0,0,0,0,1",
    ],
)
def test_several_words_of_a_motion_are_refused_by_name(statement):
    found, diagnostics = read(f"{HEAD}{statement}\nGOTO/9,0,0\n", "part.cl", ReadOptions())
    assert found is None
    assert [(fault.code, fault.place.line, fault.found) for fault in errors(diagnostics)] == [
        ("L401", 6, statement.partition("/")[0])
    ]


def drilled(dialect, cycle, between):
    """Feeds of the strokes down, mm/s, and dwells, of two holes with statements between them."""
    text = f"{HEAD}SPINDL/1200,CLW\nGOTO/0,0,30\n{cycle}\nGOTO/7,0,0\n{between}\nGOTO/9,0,0\nCYCLE/OFF\n"
    found = program(text, dialect=dialect)
    down = (found.kind == Kind.LINE) & (np.abs(found.position[:, 2] + 5) < 1e-9)
    return found.feed[down].tolist(), [event.value for event in found.events if event.kind is EventKind.DWELL]


@pytest.mark.parametrize(
    "cycle, between, feeds",
    [  # [NCCS PostWorks] cycle.f: PFEED is set by a feed of CYCLE alone, and keeps its mode, per minute or per turn
        ("DEPTH,5,CLEAR,2", "FEDRAT/60,MMPM", [10, 1]),
        ("DEPTH,5,CLEAR,2", "CYCLE/OFF\nFEDRAT/60,MMPM\nRAPID\nGOTO/8,0,9\nCYCLE/ON", [10, 1]),
        ("DEPTH,5,CLEAR,2", "FEDRAT/.1,MMPR\nSPINDL/2400,CLW", [10, 4]),
        ("DEPTH,5,CLEAR,2,MMPM,120", "SPINDL/2400,CLW", [2, 2]),
        ("DEPTH,5,CLEAR,2,MMPR,.1", "SPINDL/2400,CLW", [2, 4]),
        ("DEPTH,5,CLEAR,2,MMPR,.1", "CYCLE/OFF\nSPINDL/600,CLW\nRAPID\nGOTO/8,0,9\nCYCLE/ON", [2, 1]),
        ("DEPTH,5,CLEAR,2,IPR,.01", "UNITS/MM\nSPINDL/600,CLW", [5.08, 2.54]),
    ],
)
def test_a_cycle_goes_on_with_the_feed_and_speed_at_its_holes(cycle, between, feeds):
    assert drilled("creo", f"CYCLE/DRILL,{cycle}", between)[0] == pytest.approx(feeds)


def test_a_dwell_in_turns_goes_on_with_the_speed_at_its_holes():
    cycle = "CYCLE/DRILL,RAPTO,2,FEDTO,-5,DWELL,REV,6"
    assert drilled("nx", cycle, "SPINDL/600,CLW")[1] == pytest.approx([0.3, 0.6])


@pytest.mark.parametrize("between, line", [("FEDRAT/INVERS", 10), ("COOLNT/OFF\nFEDRAT/2,INVERS", 11)])
def test_a_cycle_whose_feed_ends_is_refused_where_a_hole_follows(between, line):
    text = f"{HEAD}GOTO/0,0,30\nSPINDL/1200,CLW\nCYCLE/DRILL,DEPTH,5,CLEAR,2\nGOTO/7,0,0\n{between}\n"
    assert codes(f"{text}GOTO/9,0,0\nCYCLE/OFF\n", dialect="creo") == [("L412", line)]
    program(f"{text}CYCLE/OFF\nRAPID\nGOTO/9,0,30\n", dialect="creo")


def test_holes_that_cutcom_would_move_aside_are_refused():
    """[NCCS PostWorks] cycle.f: CYCCUT, a cycle with CUTCOM on."""
    holes = "GOTO/9,0,0\nCYCLE/DRILL,DEPTH,5,CLEAR,2\nGOTO/20,0,0\nGOTO/20,9,0\nCYCLE/OFF\n"
    text = f"{HEAD}CUTCOM/LEFT\n{holes}CUTCOM/OFF\nGOTO/30,0,0\n"
    assert codes(text, dialect="creo", contour_data="contour") == [("L412", 9)]
    assert codes(text, dialect="creo", contour_data="centre", wear={1: 0.1}) == [("L412", 9)]
    assert not program(text, dialect="creo", contour_data="centre").side_offset.any()
    after = text.replace("CUTCOM/OFF\n", "").replace("CYCLE/DRILL", "CUTCOM/OFF\nCYCLE/DRILL")
    assert program(after, dialect="creo", contour_data="contour").side_offset.any()
