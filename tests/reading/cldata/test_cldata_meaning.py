# SPDX-License-Identifier: LGPL-2.1-or-later
"""What statements of CL data mean: feeds, speeds, frames, units, arcs, cycles, compensation."""

import numpy as np
import pytest

from pkm_post.geometry import arc_sweep
from pkm_post.model import EventKind, Kind, Tool
from pkm_post.model.diagnostics import errors
from pkm_post.reading.cldata import ReadOptions, read

MICRON = 1e-3
HEAD = "UNITS/MM\nLOADTL/1,LENGTH,100\nCUTTER/10\nFEDRAT/600,MMPM\nGOTO/0,0,0\n"


def program(text, **options):
    found, diagnostics = read(text, "part.cl", ReadOptions(**options))
    assert not errors(diagnostics), [str(fault) for fault in diagnostics]
    return found


def last_feed(statement):
    return program(f"{HEAD}SPINDL/1200,CLW\n{statement}\nGOTO/30,0,0\n").feed[-1]


@pytest.mark.parametrize(
    "statement, feed",
    [
        ("FEDRAT/60", 1), ("FEDRAT/60,MMPM", 1), ("FEDRAT/MMPM,60", 1), ("FEDRAT/6,IPM", 2.54), ("FEDRAT/PERMIN,60", 1),
        ("FEDRAT/0.1,MMPR", 2), ("FEDRAT/PERREV,0.1", 2), ("FEDRAT/INVERS,4", 2), ("FEDRAT/INVERS,AUTO", 10),
        ("FEDRAT/.1,MMPR\nSPINDL/2400,CLW", 4), ("FEDRAT/LENGTH,5,60", 1),
    ],
)  # fmt: skip
def test_feeds_in_every_order(statement, feed):
    assert last_feed(statement) == pytest.approx(feed)


@pytest.mark.parametrize(
    "statement, speed",
    [
        ("SPINDL/RPM,900,CLW", 900), ("SPINDL/900,RPM,CCLW", -900), ("SPINDL/CLW,900", 900), ("SPINDL/OFF", 0),
        ("SPINDL/900,CLW\nSPINDL/OFF\nSPINDL/ON", 900), ("SPINDL/MAXRPM,2000,900,CLW", 900),
        ("SPINDL/62.83185307,SMM,CLW", 2000),  # 62.83 m/min over pi * 10 mm
    ],
)  # fmt: skip
def test_speeds_in_every_order(statement, speed):
    found = program(f"{HEAD}{statement}\nGOTO/1,0,0\n")
    assert [e.value for e in found.events if e.kind is EventKind.SPINDLE][-1] == pytest.approx(speed)


def test_rapid_is_for_one_motion():
    assert program(HEAD + "RAPID\nGOTO/1,0,0\nGOTO/2,0,0\n").kind.tolist() == [Kind.RAPID, Kind.RAPID, Kind.LINE]


def test_coolant_dwell_and_stops_are_events():
    found = program(HEAD + "COOLNT/MIST\nDELAY/2.5\nOPSTOP\nSTOP\nCOOLNT/OFF\nGOTO/1,0,0\n")
    kinds = [(event.row, event.kind.name, event.value) for event in found.events[1:]]
    assert kinds == [(1, "COOLANT", 2), (1, "DWELL", 2.5), (1, "STOP", 1), (1, "STOP", 0), (1, "COOLANT", 0)]


def test_inches_and_an_override_of_the_unit():
    text = "UNITS/INCHES\nFEDRAT/60,IPM\nGOTO/1,0,0\nGOTO/2,0,0\n"
    assert program(text).position[:, 0] == pytest.approx([25.4, 50.8])
    assert program(text).feed[1] == pytest.approx(25.4)
    assert program(text, units="mm").position[:, 0] == pytest.approx([1, 2])
    assert program(text, units="mm").feed[1] == pytest.approx(1)


def test_the_axis_is_modal_and_normals_are_mapped():
    text = HEAD + "GOTO/1,0,0,0,.6,.8\nGOTO/2,0,0\nTLAXIS/1,0,0\nGOTO/3,0,0\nMULTAX/OFF\nGOTO/4,0,0\n"
    assert program(text).tool_axis[1:] == pytest.approx(np.array([[0, 0.6, 0.8], [0, 0.6, 0.8], [1, 0, 0], [0, 0, 1]]))
    names = ("x", "y", "z", "i", "j", "k", "nx", "ny", "nz")
    found = program(HEAD + "GOTO/1,0,0,0,0,1,1,0,0\n", goto_values={9: names})
    assert np.isnan(found.normal[0]).all()
    assert found.normal[1].tolist() == [1, 0, 0]


def test_normals_turn_with_the_frame():
    """The second frame is the first turned by 90 degrees about Z: X becomes Y, and Y becomes -X."""
    names = ("x", "y", "z", "i", "j", "k", "px", "py", "pz", "nx", "ny", "nz")
    text = "MSYS/0,0,0,1,0,0,0,1,0\nGOTO/1,2,3,0,0,1,9,9,9,.6,.8,0\nMSYS/5,0,0,0,1,0,-1,0,0\n"
    found = program(f"{HEAD}{text}GOTO/1,2,3,1,0,0,9,9,9,.6,.8,0\nGOTO/1,2,4\n", goto_values={12: names})
    assert found.normal[1:] == pytest.approx(np.array([[0.6, 0.8, 0], [-0.8, 0.6, 0], [np.nan] * 3]), nan_ok=True)
    assert found.position[2] == pytest.approx([3, 1, 3])
    assert found.tool_axis[2:] == pytest.approx(np.array([[0, 1, 0]] * 2))


def test_points_follow_on_lines_of_their_own():
    found = program(
        HEAD + "RAPID\nGOTO/1,0,0,0,.6,.8\n$$ note\n2,0,0\n\n3,0,0,1,0,0\n  4.,-.5, 1E1 $\n,0,0,1\nGODLTA/1,0,0\n"
    )
    assert found.position[1:].tolist() == [[1, 0, 0], [2, 0, 0], [3, 0, 0], [4, -0.5, 10], [5, -0.5, 10]]
    assert found.tool_axis[2:5] == pytest.approx(np.array([[0, 0.6, 0.8], [1, 0, 0], [0, 0, 1]]))
    assert found.kind[1:].tolist() == [Kind.RAPID, *[Kind.LINE] * 4]
    assert found.line[1:].tolist() == [7, 9, 11, 12, 14]
    names = ("x", "y", "z", "i", "j", "k", "nx", "ny", "nz")
    mapped = program(HEAD + "GOTO/1,0,0\n2,0,0,0,0,1,1,0,0\n", goto_values={9: names})
    assert mapped.normal[2].tolist() == [1, 0, 0]


def test_text_for_the_post_processor_is_reported_once():
    text = "INSERT M8\nGOTO/1,0,0\nINSERT/M9\n"
    diagnostics = read(HEAD + text, "part.cl")[1]
    assert [(fault.code, fault.found, fault.place.line) for fault in diagnostics] == [("L404", "INSERT, 2 times", 6)]
    assert read(HEAD + text, "part.cl", ReadOptions(dialect="solidworks"))[1] == ()


def test_increments_add_up_and_their_axis_is_absolute():
    found = program(HEAD + "GODLTA/1,0,0\nGODLTA/0,2,0,1,0,0\nGOTO/9,9,9\nGODLTA/0,0,1\n")
    assert found.position[1:].tolist() == [[1, 0, 0], [1, 2, 0], [9, 9, 9], [9, 9, 10]]
    assert found.tool_axis[2].tolist() == [1, 0, 0]


QUARTER = "GOTO/10,0,0\n{}GOTO/0,10,0\n"


@pytest.mark.parametrize(
    "arc",
    [
        "CIRCLE/0,0,0,0,0,1\n", "CIRCLE/0,0,0,0,0,1,10\n", "CIRCLE/0,0,0,0,0,1,10,.01,.5,10,0\n",
        "MOVARC/0,0,0,0,0,1,10,ANGLE,90\n", "MOVARC/0,0,0,0,0,-1,10,ANGLE,90\n", "MOVARC/0,0,0,0,0,1,10\n",
        "MOVARC/CENTER,0,0,0,AXIS,0,0,1,RADIUS,10\n",
    ],
)  # fmt: skip
def test_forms_of_arcs_with_a_point_behind(arc):
    found = program(HEAD + QUARTER.format(arc))
    assert found.kind[-1] == Kind.ARC
    assert found.arc_axis[-1] == pytest.approx([0, 0, 1])
    assert found.arc_centre[-1] == pytest.approx([0, 0, 0])


@pytest.mark.parametrize(
    "arc, way",
    [
        ("INDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,0,10),ON,(LINE/0,0,0,0,10,0)\n", 1),
        ("INDIRV/0,-1,0\nTLON,GOFWD/(CIRCLE/0,0,0,10),ON,(LINE/0,0,0,0,10,0)\n", -1),
        ("INDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/CANON,0,0,0,0,0,-1,10),ON,(LINE/0,0,0,0,10,0)\n", 1),
    ],
)
def test_arcs_that_bring_their_end(arc, way):
    found = program(f"{HEAD}GOTO/10,0,0\nAUTOPS\n{arc}")
    assert found.position[-1] == pytest.approx([0, 10, 0])
    assert found.arc_axis[-1] == pytest.approx([0, 0, way])


def test_the_vote_takes_the_hand_with_the_shorter_arcs():
    arcs = "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,-1\nGOTO/0,10,0\nCIRCLE/0,0,0,0,0,-1\nGOTO/-10,0,0.0\n"
    found = program(HEAD + arcs)
    assert found.arc_axis[-1] == pytest.approx([0, 0, 1])
    assert found.reading == ("arcs are left-handed: 2 of 2 are then shorter than half a turn",)
    assert program(HEAD + arcs, hand="left").reading == ()
    more = arcs + "CIRCLE/0,0,0,0,0,-1\nGOTO/0,10,0\n"  # three quarters of a turn, if the two before are a quarter
    assert program(HEAD + more).reading == ("arcs are left-handed: 2 of 3 are then shorter than half a turn",)


def test_an_arc_to_its_start_is_a_full_turn():
    found = program(HEAD + "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1\nGOTO/10,0,0\n", hand="right")
    sweep = arc_sweep(found.position[-2], found.position[-1], found.arc_centre[-1], found.arc_axis[-1])
    assert sweep == pytest.approx(2 * np.pi)


def test_turns_of_a_helix_rise_evenly():
    times = "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10,.01,.5,10,0,TIMES,3\nGOTO/-10,0,10\n"
    found = program(HEAD + times, hand="right")
    assert found.position[-3:] == pytest.approx(np.array([[10, 0, 4], [10, 0, 8], [-10, 0, 10]]), abs=MICRON)
    helical = "GOTO/10,0,0\nHELICAL/0,0,0,0,1,0,0,0,1,4,10,-10,0,10\n"
    assert program(HEAD + helical).position == pytest.approx(found.position, abs=MICRON)
    assert program(HEAD + helical).arc_axis[-1] == pytest.approx([0, 0, 1])


def test_frames_take_points_to_the_first_one():
    text = "UNITS/MM\nMSYS/5,0,0,1,0,0,0,1,0\nGOTO/1,2,3\nMSYS/5,0,0,0,1,0,-1,0,0\nFEDRAT/60\nGOTO/1,2,3,1,0,0\n"
    assert program(text).position == pytest.approx(np.array([[1, 2, 3], [-2, 1, 3]]))
    assert program(text).tool_axis[1] == pytest.approx([0, 1, 0])
    assert program(text, frame="absolute").position == pytest.approx(np.array([[6, 2, 3], [3, 1, 3]]))


@pytest.mark.parametrize(
    "statement, position",
    [
        ("ORIGIN/1,1,1", [0, 1, 2]), ("ORIGIN/1,1,1,0,1,0,0,0,1", [1, 0, 2]), ("TRANS/1,1,1", [2, 3, 4]),
        ("TRANS/0,-1,0,5,1,0,0,0,0,0,1,0", [3, 1, 3]), ("TRANS/1,1,1\nTRANS/NOMORE", [1, 2, 3]),
    ],
)  # fmt: skip
def test_shifts_of_the_origin(statement, position):
    assert program(f"{HEAD}{statement}\nGOTO/1,2,3\n").position[-1] == pytest.approx(position)


def test_a_solidworks_frame_gives_the_axis_alone():
    text = "UNIT/MM\nTRNTYP/WORLD,0,0,0\nCSYS/0,-.8,-.6,7,1,0,0,0,0,-.6,.8,0\nGOTO/1,2,3\n"
    assert program(text).position[0].tolist() == [1, 2, 3]
    assert program(text).tool_axis[0] == pytest.approx([-0.6, 0, 0.8])


def test_compensation_has_side_radius_and_plane():
    text = "GOTO/1,0,0\nCUTCOM/LEFT\nGOTO/2,0,0\nCUTCOM/RIGHT,ZXPLAN\nGOTO/3,0,0\nCUTCOM/OFF\nGOTO/4,0,0\n"
    found = program("$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_PROFILE\n" + HEAD + text)
    assert found.side_offset[1:].tolist() == [0, 5, -5, 0]
    assert found.plane[1:].tolist() == [2, 2, 1, 2]
    centre = program("$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_CENTER\n" + HEAD + text)
    assert not centre.side_offset.any()


def heights(cycle):
    found = program(f"{HEAD}GOTO/0,0,30\n{cycle}\nGOTO/7,0,1\nCYCLE/OFF\n")
    assert found.position[2:, 0] == pytest.approx(7)
    return found.position[2:, 2].tolist(), found.kind[2:].tolist(), found


def test_a_drilled_hole():
    z, kind, found = heights("CYCLE/DRILL,FEDTO,5,MMPM,120,RAPTO,2,RTRCTO,20,DWELL,1.5")
    assert z == pytest.approx([30, 3, -4, 21])
    assert kind == [Kind.RAPID, Kind.RAPID, Kind.LINE, Kind.RAPID]
    assert found.feed[4] == pytest.approx(2)
    assert [(e.row, e.value) for e in found.events if e.kind is EventKind.DWELL] == [(5, 1.5)]


@pytest.mark.parametrize(
    "cycle, z",
    [
        ("CYCLE/DEEP,DEPTH,5,STEP,2,CLEAR,1", [30, 2, -1, 2, -0.5, -3, 2, -2.5, -4, 2]),
        ("CYCLE/BRKCHP,DEPTH,5,STEP,3,CLEAR,1", [30, 2, -2, -1.5, -4, 2]),
        ("CYCLE/DEEP2,FEDTO,5,1STPECK,4,SUBPECK,2,RAPTO,1", [30, 2, -3, 2, -2.5, -4, 2]),
        ("CYCLE/CLEAR\nCYCLE/DRILL,FEDTO,5,RAPTO,2,RTRCTO,20", [30, 3, -4, 3]),
        ("CYCLE/INIT\nCYCLE/DRILL,FEDTO,5,RAPTO,2", [30, 3, -4, 30]),
    ],
)
def test_cycles_that_peck(cycle, z):
    assert heights(cycle)[0] == pytest.approx(z)


@pytest.mark.parametrize(
    "dialect, cycle, z",
    [
        ("nx", "CYCLE/DRILL,RAPTO,2,FEDTO,-5", [30, 3, -4, 3]),
        ("nx", "CYCLE/DRILL,CLEAR,2,FEDTO,-5,RTRCTO,AUTO,MMPM,60", [30, 3, -4, 30]),
        ("nx", "CYCLE/DRILL,RAPTO,2,FEDTO,-5,RTRCTO,9,MANUAL,MMPM,60", [30, 3, -4, 10]),
        ("nx", "CYCLE/DRILL,DEEP,STEP,3,RAPTO,1,FEDTO,-5", [30, 2, -2, 2, -1.5, -4, 2]),
        ("nx", "CYCLE/DRILL,BRKCHP,STEP,3,RAPTO,1,FEDTO,-5", [30, 2, -2, -1.5, -4, 2]),
        ("nx", "CYCLE/DRILL,CSINK,RAPTO,2,FEDTO,-5", [30, 3, -4, 3]),
        ("nx", "CYCLE/BORE,RAPTO,2,FEDTO,-5", [30, 3, -4, 3]),
        ("creo", "CYCLE/DRILL,DEPTH,5,MMPM,60,CLEAR,6,RAPTO,4", [30, 3, -4, 7]),
        ("creo", "CYCLE/DRILL,DEPTH,5,MMPM,60,CLEAR,6,RETURN,9", [30, 7, -4, 10]),
        ("creo", "CYCLE/DRILL,DEPTH,5,MMPM,60,CLEAR,6,RETURN,0", [30, 7, -4, 30]),
        ("creo", "CYCLE/CSINK,DEPTH,5,MMPM,60,CLEAR,6", [30, 7, -4, 7]),
        ("creo", "CYCLE/REAM,DEPTH,5,MMPM,60,CLEAR,6,RAPTO,4", [30, 3, -4, 3, 7]),
        ("creo", "CYCLE/DEEP,DEPTH,5,STEP,3,MMPM,60,CLEAR,6,RAPTO,5", [30, 2, -2, 7, -1.5, -4, 7]),
        ("solidworks", "CYCLE/DRILL,FEDTO,5,MMPM,60,RAPTO,2,RTRCTO,9,DWELL,0", [30, 3, -4, 10]),
        ("solidworks", "CYCLE/DEEP,FEDTO,5,INCR,3,MMPM,60,RAPTO,1,RTRCTO,9", [30, 2, -2, 2, -1.5, -4, 10]),
        ("camplete", "CYCLE/DRILL, FEDTO, 5, MMPM, 60, CLEAR, 10, RTRCTO,9, RAPTO, 2", [30, 3, -4, 10]),
        ("camplete", "CYCLE/DRILL, FEDTO, 5, MMPM, 60, CLEAR, -3, RETURN, -3, RAPTO, 2", [30, 3, -4, 30]),
        (
            "camplete",
            "CYCLE/DRILL, DEEP, FEDTO, 5, INCR, 3, MMPM, 60, CLEAR, 30, RAPTO, 1",
            [30, 2, -2, 2, -1.5, -4, 30],
        ),
        ("camplete", "CYCLE/BRKCHP, FEDTO, 5, INCR, 3, MMPM, 60, CLEAR, 30, RAPTO, 1", [30, 2, -2, -1.5, -4, 30]),
        ("camplete", "CYCLE/REAM, FEDTO, 5, MMPM, 60, CLEAR, 30, RAPTO, 1", [30, 2, -4, 2, 30]),
    ],
)
def test_each_maker_has_words_of_its_own(dialect, cycle, z):
    found = program(f"{HEAD}GOTO/0,0,30\n{cycle}\nGOTO/7,0,1\nCYCLE/OFF\n", dialect=dialect)
    assert found.position[2:, 2] == pytest.approx(z)


@pytest.mark.parametrize(
    "names, cycle, z, feed",
    [
        ("depth feed clearance", "DRILL,5.,60.,2.,MMPM", [30, 3, -4, 3], 1),
        ("depth feed clearance", "DRILL,5.,60.,MMPM,2.", [30, 3, -4, 3], 1),
        ("depth feed clearance", "DRILL,5.,IPM,6.,2.", [30, 3, -4, 3], 2.54),
        ("depth feed clearance step", "DEEP,5,60,MMPM,1,3", [30, 2, -2, 2, -1.5, -4, 2], 1),
        ("feed depth clearance return dwell", "DRILL,60,5,2,9,3", [30, 3, -4, 10], 1),
        ("depth clearance", "DRILL,5,2,STEP", None, None),
        ("depth clearance", "DRILL,5,2,60", None, None),
        ("", "DRILL,5,2", None, None),
    ],
)
@pytest.mark.parametrize("dialect", ["catia", "creo", "nx", None])
def test_numbers_without_words_are_what_an_option_says(names, cycle, z, feed, dialect):
    options = ReadOptions(dialect=dialect, cycle_values=tuple(names.split()))
    if dialect == "nx":
        cycle = cycle.replace("DEEP", "DRILL,DEEP")
    found, diagnostics = read(f"{HEAD}GOTO/0,0,30\nCYCLE/{cycle}\nGOTO/7,0,1\nCYCLE/OFF\n", "part.cl", options)
    if z is None:
        assert [fault.code for fault in errors(diagnostics)] == ["L412" if names or dialect == "creo" else "L420"]
    else:
        assert found.position[2:, 2] == pytest.approx(z)
        assert found.feed[4] == pytest.approx(feed)


@pytest.mark.parametrize(
    "dialect, cycle, code",
    [
        ("nx", "DRILL,RAPTO,2,FEDTO,5", "L412"), ("nx", "DRILL,RAPTO,2,CLEAR,3,FEDTO,-5", "L412"),
        ("nx", "DRILL,RAPTO,-2,FEDTO,-5", "L412"), ("nx", "DRILL,RAPTO,2,FEDTO,-5,CAM,3", "L412"),
        ("nx", "DRILL,RAPTO,2,FEDTO,-5,DWELL,ON", "L412"), ("nx", "BORE,BACK,RAPTO,2,FEDTO,-5", "L412"),
        ("nx", "DRILL,TEXT,RAPTO,2,FEDTO,-5", "L412"), ("nx", "TAP,RAPTO,2,FEDTO,-5", "L440"),
        ("creo", "DRILL,DEPTH,5,CLEAR,2,RAPTO,3", "L412"), ("creo", "THRU,DEPTH,5,CLEAR,2,DEPTH,9", "L412"),
        ("creo", "BORE,DEPTH,5,CLEAR,2", "L445"), ("creo", "DRILL,DEPTH,-5,CLEAR,2", "L412"),
        ("creo", "BRKCHP,DEPTH,5,STEP,2,CLEAR,2,DWELL,1", "L412"),
        ("creo", "DEEP,DEPTH,5,STEP,2,STEP,1,CLEAR,2", "L412"),
        ("creo", "BRKCHP,DEPTH,5,STEP,2,CLEAR,2,TIMES,1", "L412"), ("creo", "DRILL,DEPTH,5,CLEAR,2,REV,3", "L412"),
        ("creo", "DRILL,DEPTH,5,CLEAR,2,DWELL,-1", "L412"), ("creo", "INIT", "L445"),
        ("creo", "DRILL,5,60,MMPM", "L412"), ("creo", "DRILL,5,60,MMPM,2,3", "L412"),
        ("creo", "BORE,5,60,MMPM,2", "L445"), ("creo", "TAP,5,60,MMPM,1.5,2", "L440"),
        ("creo", "DRILL,-5,60,MMPM,2", "L412"), ("creo", "DEEP,5,60,MMPM,2", "L412"),
        ("solidworks", "BRKCHP,FEDTO,5,STEP,2,RAPTO,2", "L445"), ("solidworks", "DRILL,FEDTO,-5,RAPTO,2", "L412"),
        (None, "DRILL,FEDTO,-5,RAPTO,2", "L419"), (None, "DEEP,FEDTO,5,RAPTO,2,STEP,3", "L419"),
        (None, "DRILL,FEDTO,5,CLEAR,2", "L419"), (None, "DRILL,DEPTH,5,FEDTO,5,CLEAR,2", "L419"),
        (None, "DRILL,FEDTO,5,RAPTO,2,RTRCTO,AUTO", "L419"), (None, "TWIST,DEPTH,5,CLEAR,2", "L445"),
        (None, "DRILL,DEPTH,5,CLEAR,2,TWIST,3", "L412"), (None, "DRILL,DEPTH,CLEAR,2", "L412"),
        ("makino", "DRILL,FEDTO,-5,RAPTO,2", "L419"), ("catia", "DRILL,FEDTO,-5,RAPTO,2", "L419"),
    ],
)  # fmt: skip
def test_cycles_that_are_refused(dialect, cycle, code):
    found, diagnostics = read(f"{HEAD}CYCLE/{cycle}\nGOTO/7,0,1\nCYCLE/OFF\n", "part.cl", ReadOptions(dialect=dialect))
    assert found is None
    assert [fault.code for fault in errors(diagnostics)] == [code]


CREO_HEAD = "$$*   Pro/CLfile  Version 9.0\n" + HEAD


@pytest.mark.parametrize(
    "cycle, z, feed",
    [  # [PTC holemaking], cycle_format fixed: CYCLE / type, z, f, units, t, r, i, t for TAP alone, i for DEEP alone
        ("DRILL,5.,60.,MMPM,2.", [30, 3, -4, 3], 60),
        ("FACE,5.,6.,IPM,2.", [30, 3, -4, 3], 152.4),
        ("CSINK,1.5,60.,MMPM,2.", [30, 3, -0.5, 3], 60),
        ("DEEP,5,60,MMPM,1,3", [30, 2, -2, 2, -1.5, -4, 2], 60),
        ("THRU,5.,60.,MMPM,2.", [30, 3, -4, 3], 60),
        ("THRU,DEPTH,5,MMPM,60,CLEAR,2", [30, 3, -4, 3], 60),
        ("REAM,5.,60.,MMPM,2.", [30, 3, -4, 3], 60),
    ],
)
def test_numbers_of_creo_have_one_order(cycle, z, feed):
    text = f"{CREO_HEAD}GOTO/0,0,30\nCYCLE/{cycle}\nGOTO/7,0,1\nCYCLE/OFF\n"
    found = program(text)
    assert found.position[2:, 2] == pytest.approx(z)
    assert found.feed[4] * 60 == pytest.approx(feed)
    if "DEPTH" not in cycle:
        assert found.reading[-1].endswith("in the order of Creo")


def test_gohome_is_a_move_in_the_mode_in_force():
    path = "FROM/0,0,10\nRAPID\nGOTO/1,2,3\nGOTO/1,2,0\n"
    at_feed = program(f"{HEAD}{path}GOHOME/0,0,10\n")
    rapid = program(f"{HEAD}{path}RAPID\nGOHOME/0,0,10,0,0.6,0.8\n")
    assert at_feed.position[-1].tolist() == rapid.position[-1].tolist() == [0, 0, 10]
    assert (at_feed.kind[-1], rapid.kind[-1]) == (Kind.LINE, Kind.RAPID)
    assert at_feed.feed[-1] == at_feed.feed[-2]
    assert rapid.tool_axis[-1].tolist() == [0, 0.6, 0.8]


@pytest.mark.parametrize("end", ["FINI", "END/", "END\nPPRINT/'A'", "REWIND"])
def test_a_file_of_mfgsuite_goes_home_and_ends(end):
    """As Fusion's post Mori APT writes it, with slashes after words without items [Autodesk posts]."""
    text = f"{HEAD}GOTO/1,2,3\nGOHOME/\n{end}\n"
    found, _ = read(text, "part.apt", ReadOptions(needs_end=True, machine_zero=(4, 5, 6)))
    assert found.position[-1].tolist() == [4, 5, 6]


def test_gohome_without_a_point_goes_to_the_home_of_the_machine_in_any_frame():
    text = f"{HEAD}MSYS/0,0,0,1,0,0,0,1,0\nGOTO/1,2,3\nMSYS/10,0,0,0,1,0,-1,0,0\nGOTO/1,2,3\nRAPID\nGOHOME\n"
    found = program(text, dialect="nx", machine_zero=(0.0, 20.0, 300.0))
    assert found.position[-1] == pytest.approx([0, 20, 300])
    assert found.kind[-1] == Kind.RAPID


@pytest.mark.parametrize(
    ("statement", "code"),
    [("FEDRAT/LENGTH,80", None), ("FEDRAT/", "L402"), ("CUTTER/DISPLY,1", None), ("CUTTER/TOOL,1", "L402"),
     ("COOLNT/TAPKUL", None), ("COOLNT/STEAM", "L402"), ("INCLUDE/OTHER", "L401"), ("READ/2,OTHER", "L401")],
)  # fmt: skip
def test_words_beside_the_motion_leave_it_alone_or_are_refused(statement, code):
    found, diagnostics = read(f"{HEAD}{statement}\nGOTO/1,2,3\n", "part.cl")
    assert [fault.code for fault in errors(diagnostics)] == ([code] if code else [])
    assert code or found.position[-1].tolist() == [1, 2, 3]


@pytest.mark.parametrize("text", ["PPRINT COST 5 $", "INSERT G4 X5 $", "REMARK a ~", "PPRINT 'A $"])
@pytest.mark.parametrize("lost", ["GOTO/1,2,3", "RAPID", " fedrat / 5", "CALSUB/1"])
def test_a_statement_that_a_text_would_swallow_is_refused(text, lost):
    diagnostics = read(f"{HEAD}{text}\n{lost}\nGOTO/4,5,6\n", "part.cl")[1]
    line = HEAD.count("\n") + 1
    assert [(fault.code, fault.place.line) for fault in errors(diagnostics)] == [("L401", line)]
    assert lost.strip().partition("/")[0].strip().upper() in str(errors(diagnostics)[0].found)
    goes_on = program(f"{HEAD}{text}\nand more: GOTO it\nGOTO/4,5,6\n")
    assert goes_on.position[-1].tolist() == [4, 5, 6]


def test_an_increment_after_a_point_that_is_no_number_has_no_fault_of_its_own():
    """NumPy warned of its matrix product."""
    diagnostics = read(f"{HEAD}GOTO/1e999,2,3\nTRACUT/1,2,3\nGODLTA/1,1,1\n", "part.cl")[1]
    assert [fault.code for fault in errors(diagnostics)] == ["L103"]


def test_a_gauge_length_below_zero_is_refused():
    diagnostics = read(f"{HEAD}LOADTL/2,LENGTH,-100\nGOTO/1,2,3\n", "part.cl")[1]
    assert [fault.code for fault in errors(diagnostics)] == ["L403"]


def test_rapid_passes_a_from():
    found = program(f"{HEAD}GOTO/0,0,9\nRAPID\nFROM/0,0,10\nGOTO/1,2,3\nGOTO/1,2,0\n")
    assert found.kind[-2:].tolist() == [Kind.RAPID, Kind.LINE]


@pytest.mark.parametrize(
    ("statement", "code"),
    [("ROTABL/0.,CLW,BAXIS", None), ("ROTATE/TABLE,ATANGL,0", None), ("ROTABL/30.,CLW,AAXIS", "L401"),
     ("ROTABL/AAXIS", "L401"), ("ROTHED/0,5", "L401")],
)  # fmt: skip
def test_a_rotary_axis_may_turn_by_nothing_alone(statement, code):
    found, diagnostics = read(f"{HEAD}{statement}\nGOTO/1,2,3\n", "part.cl")
    assert [fault.code for fault in errors(diagnostics)] == ([code] if code else [])
    assert (found is None) == bool(code)


@pytest.mark.parametrize(
    ("dialect", "strokes", "cycle", "z"),
    [
        ("creo", "ream", "BORE,DEPTH,5,MMPM,60,CLEAR,2", [30, 3, -4, 3]),
        ("solidworks", "break", "BRKCHP,FEDTO,5,INCR,4,MMPM,60,RAPTO,2", [30, 3, -3, -2.5, -4, 3]),
        ("catia", "deep", "DEEPHL,DEPTH,5,STEP,4,MMPM,60,CLEAR,2", [30, 3, -3, 3, -2.5, -4, 3]),
        ("nx", "drill", "BORE,RAPTO,2,FEDTO,-5,MMPM,60", [30, 3, -4, 3]),
    ],
)
def test_an_option_says_what_a_kind_of_cycle_does(dialect, strokes, cycle, z):
    text = f"{HEAD}GOTO/0,0,30\nCYCLE/{cycle}\nGOTO/7,0,1\nCYCLE/OFF\n"
    kind = cycle.partition(",")[0]
    found = program(text, dialect=dialect, cycle_kinds={kind: strokes})
    assert found.position[2:, 2] == pytest.approx(z)
    assert (found.kind[-1] == Kind.LINE) == (strokes == "ream")
    assert f"{kind} is {strokes}, as the option says" in found.reading[-1]


def test_a_kind_of_cycle_without_known_strokes_is_refused():
    text = f"{HEAD}CYCLE/WEBDRL,DEPTH,5,CLEAR,2\nGOTO/7,0,1\nCYCLE/OFF\n"
    found, diagnostics = read(text, "part.cl", ReadOptions(dialect="creo"))
    assert (found, [fault.code for fault in errors(diagnostics)]) == (None, ["L445"])


COUNTERSINK = "CYCLE/DRILL,CSINK,{diameter},RAPTO,2,MMPM,60\nGOTO/7,0,1\nCYCLE/OFF\n"


@pytest.mark.parametrize(
    ("cutter", "diameter", "depth"),
    [  # a cone of 90 degrees is as deep as half its diameter
        ("TLDATA/DRILL,MILL,20,0,50,90,35", 12, 6),
        ("TLDATA/DRILL,20,0,50,118,35", 12, 6 / np.tan(np.radians(59))),
        ("CUTTER/20,0,10,0,45,0,50", 8, 4),
    ],
)
def test_a_countersink_by_diameter_is_as_deep_as_the_cone_of_the_tool(cutter, diameter, depth):
    text = f"{HEAD}{cutter}\nGOTO/0,0,30\n{COUNTERSINK.format(diameter=diameter)}"
    found = program(text, dialect="nx", cycle_values=("diameter",))
    assert found.position[-2, 2] == pytest.approx(1 - depth)


@pytest.mark.parametrize("cutter", ["CUTTER/20", "TLDATA/DRILL,MILL,10,0,50,90,35", "TLDATA/MILL,20,2,50,0,45"])
def test_a_countersink_by_diameter_needs_a_cone_of_its_size(cutter):
    text = f"{HEAD}{cutter}\nGOTO/0,0,30\n{COUNTERSINK.format(diameter=12)}"
    found, diagnostics = read(text, "part.cl", ReadOptions(dialect="nx", cycle_values=("diameter",)))
    assert (found, [fault.code for fault in errors(diagnostics)]) == (None, ["L412"])


@pytest.mark.parametrize(
    "statement, code",
    [
        ("GOHOME", "L444"),
        ("GOHOME/1,2", "L402"),
        ("CYCLE/DRILL,DEPTH,5,CLEAR,2\nGOTO/7,0,1\nGOHOME/0,0,9", "L422"),
    ],
)
def test_gohome_that_is_refused(statement, code):
    found, diagnostics = read(f"{HEAD}{statement}\n", "part.cl")
    assert (found, [fault.code for fault in errors(diagnostics)]) == (None, [code])


def test_words_may_follow_numbers():
    text = f"{HEAD}GOTO/0,0,30\nCYCLE/DRILL,  5.000,MMPM, 60.000,RAPTO,  2.0,RTRCTO, $\n 9.\nGOTO/7,0,1\nCYCLE/OFF\n"
    found = program(text, dialect="catia", cycle_values=("depth", "feed"))
    assert found.position[2:, 2] == pytest.approx([30, 3, -4, 10])
    assert found.feed[4] == pytest.approx(1)


def test_a_dwell_in_turns_follows_the_spindle():
    for dialect, cycle in (("nx", "RAPTO,2,FEDTO,-5,DWELL,REV,3"), ("creo", "DEPTH,5,CLEAR,2,REV,3")):
        text = f"{HEAD}SPINDL/RPM,120,CLW\nCYCLE/DRILL,{cycle}\nGOTO/7,0,1\nCYCLE/OFF\n"
        (dwell,) = [event for event in program(text, dialect=dialect).events if event.kind is EventKind.DWELL]
        assert dwell.value == pytest.approx(1.5)


def test_holes_follow_the_tool_axis():
    text = "GOTO/20,0,0,1,0,0\nCYCLE/DRILL,FEDTO,5,RAPTO,2\nGOTO/10,0,0\nGOTO/10,9,0\nCYCLE/OFF\n"
    found = program(HEAD + text)
    assert found.position[2:5, 0] == pytest.approx([12, 5, 12])
    assert found.position[5:, 1] == pytest.approx(9)


def test_two_words_for_one_tool_change_are_one():
    load = "LOADTL/2,LENGTH,50\n"
    found = program(f"UNITS/MM\nTOOLNO/2,MILL,8\n{load}GOTO/0,0,0\n{load}RAPID\nGOTO/1,0,0\n")
    assert [event.row for event in found.events] == [0, 1]
    assert found.tools[2].length == 50


def test_tools_are_kept_apart():
    text = "UNITS/MM\nCUTTER/10\nLOAD/TOOL,1\nGOTO/0,0,0\nCUTTER/6,3\nLOAD/TOOL,2\nRAPID\nGOTO/1,0,0\n"
    found = program(text, tools={2: Tool(2, "ball", 6.0, 3.0, 80.0)})
    assert (found.tools[1].diameter, found.tools[1].length) == (10, 0)
    assert found.tools[2].name == "ball"
    assert program(text, default_tool=Tool(0, "", 0.0, 0.0, 90.0)).tools[1].length == 90


@pytest.mark.parametrize(
    "statement, code",
    [
        ("TLCOMP/OFF", None), ("TLCOMP/ON", "L401"), ("TLCOMP/ON,LENGTH,3", "L401"), ("TLCOMP/ADJUST,1", "L401"),
        ("TLCOMP", "L401"), ("RETRCT", "L401"), ("RETRCT/ON", "L401"), ("CALSUB/1", "L401"), ("DEFSUB/1", "L401"),
        ("DNTCUT", "L401"), ("SYN/'TLAXIS','$$*TLAXIS'", None), ("SYN/'GOTO','FROM'", "L401"),
        ("SYN/'MOVETO','GOTO'\nMOVETO/1,2,3", "L401"), ("SYN/'TO','GOTO'", None), ('SYN/"A","B","rapid","C"', "L401"),
    ],
)  # fmt: skip
def test_words_that_would_change_the_motion_are_refused(statement, code):
    found, diagnostics = read(f"{HEAD}{statement}\nRAPID\nGOTO/7,0,1\n", "part.cl")
    assert [fault.code for fault in errors(diagnostics)] == ([code] if code else [])
    assert (found is None) == bool(code)


def test_increments_between_holes_count_from_point_to_point():
    drilled = "RAPID\nGOTO/0,0,9\nCYCLE/DRILL,DEPTH,5,CLEAR,2\nGOTO/10,0,0\nGODLTA/0,7,1\nCYCLE/OFF\n"
    found = program(f"{HEAD}{drilled}FROM/1,1,1\nGODLTA/1,0,0\n").position
    assert found[found[:, 2] < 0].tolist() == [[10, 0, -5], [10, 7, -4]]
    assert found[-1].tolist() == [2, 1, 1]


@pytest.mark.parametrize(
    "options, cycles, descriptions",
    [
        ({"dialect": "nx"}, ["DRILL,RAPTO,2,FEDTO,-5"], ["5: words of NX, as the option says"]),
        ({}, ["DRILL,FEDTO,5,RAPTO,2"] * 3, ["5 and 2 more: words of NCCS PostWorks, by themselves"]),
        (
            {"cycle_values": ("depth", "clearance")},
            ["DRILL,DEPTH,5,CLEAR,2", "DRILL,5,2"],
            [
                "5: words of Creo, by themselves",
                "7: words of Creo, by themselves; numbers are depth, clearance, as the option says",
            ],
        ),
    ],
)
def test_the_program_describes_how_its_cycles_were_read(options, cycles, descriptions):
    text = "UNITS/MM\nLOADTL/1,LENGTH,100\nFEDRAT/600,MMPM\nGOTO/0,0,9\n"
    text += "".join(f"CYCLE/{cycle}\nGOTO/0,0,0\n" for cycle in cycles)
    lines = [line for line in program(text, **options).reading if line.startswith("CYCLE")]
    assert lines == [f"CYCLE in line {one}" for one in descriptions]


def test_a_dialect_that_shows_says_whose_words_cycles_have():
    found = program("$$-> FEATNO / 1\nUNITS/MM\nRAPID\nGOTO/0,0,9\nCYCLE/DRILL,DEPTH,5,CLEAR,2,MMPM,60\nGOTO/0,0,0\n")
    assert found.reading == ("CYCLE in line 5: words of Creo, by the dialect",)
