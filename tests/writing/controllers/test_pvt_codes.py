# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from controller_settings import settings_for

from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.writing.controllers.pvt.codes import EVENT_CODES, check_codes, code_text, event_faults

CODES, LETTERS = settings_for().codes, settings_for().letters


@pytest.mark.parametrize(
    ("kind", "value", "text"),
    [
        (EventKind.TOOL_CHANGE, 12, "T12 M6"),
        (EventKind.SPINDLE, 18000.0, "S18000 M3"),
        (EventKind.SPINDLE, -3183.1, "S3183.1 M4"),
        (EventKind.SPINDLE, -0.0, "M5"),
        (EventKind.DWELL, 0.0001, "DWELL0.1"),
        (EventKind.DWELL, 4, "DWELL4000"),
        (EventKind.STOP, 1, "M1"),
    ],
)
def test_an_event_has_one_text(kind, value, text):
    assert code_text(Event(0, kind, value), CODES) == text


def test_a_code_with_fixed_decimals_writes_what_it_can_write_exactly():
    codes = CODES | {"spindle_clockwise": "S{value:.2f} M3"}
    check_codes(codes, LETTERS)
    assert code_text(Event(0, EventKind.SPINDLE, 1200.5), codes) == "S1200.50 M3"
    with pytest.raises(ValueError, match="would write it as 3183.10"):
        code_text(Event(0, EventKind.SPINDLE, 3183.0989), codes)


def test_the_codes_of_the_example_are_in_order_and_tell_all_meanings_apart():
    check_codes(CODES, LETTERS)
    meanings = [EVENT_CODES[name] for name in EVENT_CODES if name in CODES]
    values = [3 * meaning.sign if meaning.value is None else meaning.value for meaning in meanings]
    events = [Event(0, meaning.kind, value) for meaning, value in zip(meanings, values, strict=True)]
    texts = [code_text(event, CODES) for event in events]
    assert texts == ["T3 M6", "M5", "S3 M3", "S3 M4", "M9", "M8", "M7", "M0", "M1"]


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"coolant_mist": "M8"}, "got 'M8' for coolant_flood and coolant_mist"),
        ({"coolant_mist": "S7 M3"}, "got 'S7 M3' for spindle_clockwise and coolant_mist"),
        ({"tool_change": "S6 M{value:d}"}, "got 'S6 M3' for tool_change and spindle_clockwise"),
        ({"tool_change": "M6"}, "tool_change: expected text with one"),
        ({"tool_change": "T{value} T{value}"}, "tool_change: expected text with one"),
        ({"tool_change": "T1{value:d}"}, "apart from other digits"),
        ({"tool_change": "T{value:.0f}"}, "tool_change: expected text with one"),
        ({"tool_change": "S{value:.2f} M4"}, "for tool_change and spindle_counterclockwise"),
        ({"stop": "S1.50 M3", "spindle_clockwise": "S{value:.2f} M3"}, "got 'S1.50 M3' for spindle_clockwise and stop"),
        ({"stop": "M0 ; halt"}, "stop: expected text without ';'"),
        ({"stop": "M{value}"}, "stop: expected text without"),
        ({"stop": "DWELL1000"}, "not beginning with"),
        ({"stop": "dwell1000"}, "not beginning with"),
        ({"stop": "M0 // halt"}, "no comment"),
        ({"coolant_off": "M60==0"}, "coolant_off: expected DWELL0 behind a synchronous assignment"),
        ({"coolant_off": "DWELL0 M60|=1"}, "not beginning with"),
        ({"coolant_off": "M9 M60|=1"}, "expected DWELL0 behind a synchronous assignment"),
        ({"spindle_clockwise": "M60=={value}"}, "expected DWELL0 behind a synchronous assignment"),
        ({"stop": "INC"}, "no mode and no move of an axis, got INC"),
        ({"stop": "M0 PVT20"}, "got PVT in"),
        ({"stop": "m0rapid"}, "got rapid in"),
        ({"stop": "CLEAR"}, "got CLEAR in"),
        ({"stop": f"{LETTERS[0]}100"}, f"got {LETTERS[0]} in"),
        ({"stop": f"M0 {LETTERS[5].lower()} -1.5"}, f"got {LETTERS[5].lower()} in"),
        ({"tool_change": f"M6 {LETTERS[1]}{{value}}"}, f"got {LETTERS[1]} in"),
        ({"stop": ""}, "stop: expected"),
        ({"pallet": "M60"}, "expected the names"),
        ({"M21": "M8"}, "got 'M8' for coolant_flood and M21"),
        ({"M21": "S7 M3"}, "got 'S7 M3' for spindle_clockwise and M21"),
        ({"M21": "M{value}"}, "M21: expected text without"),
        ({"M21": "RAPID"}, "got RAPID in"),
        # the controller reads words without spaces between them
        ({"stop": f"M0 RAPID{LETTERS[0]}100"}, f"got {LETTERS[0]} in"),
        ({"stop": f"M0INC{LETTERS[1]}-5"}, f"got {LETTERS[1]} in"),
        ({"stop": f"M0 PSET{LETTERS[2]}(0)"}, f"got {LETTERS[2]} in"),
        # motors 1 to 6 are the struts
        ({"stop": "M0 HOME"}, "got HOME in"),
        ({"stop": "M0 HOMEZ1..6"}, "got HOMEZ in"),
        ({"stop": "M0 HM3"}, "got HM in"),
        ({"stop": "HMZ1..6"}, "got HMZ in"),
        ({"stop": 'M0 CMD"#1J+"'}, "got #1 in"),
        ({"stop": 'M0 cmd"# 6 k"'}, "got # 6 in"),
    ],
)
def test_a_table_of_codes_must_be_well_formed_and_invertible(change, complaint):
    with pytest.raises(ValueError, match=complaint):
        check_codes(CODES | change, LETTERS)


@pytest.mark.parametrize(
    ("code", "said"),
    [
        # times of moves, modes by their short names, and what works like one
        ("G91", "got G in"),
        ("M0 G 90", "got G in"),
        ("M0F10", "got F in"),
        ("RAPIDF10", "got F in"),
        ("TA100 TS0", "got TA in"),
        ("M8 ts(P1)", "got ts in"),
        ("TM50", "got TM in"),
        ("LIN", "got LIN in"),
        ("RPD", "got RPD in"),
        ("CIR1", "got CIR in"),
        ("NRM K-1", "got NRM in"),
        ("TSEL3", "got TSEL in"),
        ("PRELUDE1", "got PRELUDE in"),
        ('CMD"UNDEFINE ALL"', "got UNDEFINE in"),
        # the flow of the program
        ("GOTO100", "got GOTO in"),
        ("IF(P1=0)GOTO 100", "got GOTO in"),
        ("gosub 500", "got gosub in"),
        ("CALL1001.5", "got CALL in"),
        ("M0 RETURN", "got RETURN in"),
        ("RET", "got RET in"),
        # an override beyond the plan
        ('CMD"%150"', "got % in"),
        ('CMD"&1 %150"', "got % in"),
        # settings of struts and coordinate system
        ("I5190=500", "got I5190 in"),
        ("M8 i 113 = 0", "got i 113 in"),
        ("ENDIFI699=1", "got I699 in"),
        ("I100..5000=0", "got I100..5000 in"),
        ("I5000..90=0", "got I5000..90 in"),
        ("I100,7,100=0", "got I100,7,100 in"),
        ("I(P1+(P2*3))=5", r"got I\(...\) in"),
        ("IF(P1=2)I122=5", "got I122 in"),
        ('CMD"I42=1"', "got I42 in"),
        ("I10=3713991", "got I10 in"),
        ("Motor[6].MaxSpeed=0", r"got Motor\[6\].MaxSpeed in"),
        ("motor[ 1 ].maxpos = 0", r"got motor\[ 1 \].maxpos in"),
        ("Motor[P1].MaxPos=0", r"got Motor\[P1\].MaxPos in"),
        ("Motor[P(1)].MaxPos=0", r"got Motor\[P\(...\)\].MaxPos in"),
        ("Motor[axis[1]].MaxPos=0", r"got Motor\[axis\[1\]\].MaxPos in"),
        ("Motor[2].Servo.Kp*=2", r"got Motor\[2\].Servo.Kp in"),
        ("Coord[1].FeedTime=60000", r"got Coord\[1\].FeedTime in"),
        ("Coord[1].DesTimeBase+=1", r"got Coord\[1\].DesTimeBase in"),
        ("Sys.ServoPeriod=1", "got Sys.ServoPeriod in"),
    ],
)
def test_codes_that_alter_the_moves_behind_them_are_refused(code, said):
    for table in ({"stop": code}, {"M21": code}):
        with pytest.raises(ValueError, match=said):
            check_codes(CODES | table, LETTERS)


@pytest.mark.parametrize(
    "code",
    [
        "M60=1",
        "M60=$1F0 M61=$A1",
        "M60==1 DWELL0",
        "P1=SIN(30)",
        "Q127=1200 P5=-3",
        "P100..107=0",
        "P1=I122 M60=1",
        "P1=I5190",
        "M61=(I5190>500)",
        "IF(I122=5)M60=1",
        "IF(I(P1)=5)M60=1 ENDIF",
        "WHILE(M10=0)DELAY10",
        "M0 DWELL100",
        "I722=3",
        "I5290=1000",
        "I7000..7009=1",
        "I5=2",
        'CMD"#7J/"',
        'CMD"ENABLEPLC3"',
        "P1=P2%4",
        "P1=INT(P2)",
        "STOP",
        "T3 M6 S1200 D5",
        "if(Motor[1].HomeComplete==1)M60=1 DWELL0",
        "P1=Motor[1].ActPos",
        "Motor[7].JogSpeed=10",
        "Coord[2].FeedTime=1000",
        "Sys.Udata[5]=1",
        "P1=LOG(5)",
    ],
)
def test_what_machines_need_between_moves_is_accepted(code):
    check_codes(CODES | {"M21": code}, LETTERS)


def test_the_settings_of_the_own_coordinate_system_are_refused():
    check_codes(CODES | {"M21": "I5190=500"}, LETTERS, system=2)
    with pytest.raises(ValueError, match="got I5290 in"):
        check_codes(CODES | {"M21": "I5290=500"}, LETTERS, system=2)


def test_motors_that_are_no_struts_may_be_homed_and_jogged():
    check_codes(CODES | {"M21": "HOME7", "M24": "HM8", "M22": 'CMD"#16J/"', "M23": "HOMEZ 10,11"}, LETTERS)


def test_outputs_can_be_set_with_synchronous_assignments():
    # Turbo PMAC User Manual, p. 250: one behind the last move or dwell of a program is not carried out
    codes = CODES | {
        "coolant_flood": "M60==1 DWELL0",
        "coolant_off": "M60==0 DWELL0",
        "spindle_clockwise": "M70=={value} DWELL0",
    }
    check_codes(codes, LETTERS)
    assert code_text(Event(0, EventKind.COOLANT, 0.0), codes) == "M60==0 DWELL0"
    assert code_text(Event(0, EventKind.SPINDLE, 900.5), codes) == "M70==900.5 DWELL0"


def test_every_kind_of_event_has_a_code_but_dwells_and_functions():
    others = {EventKind.DWELL, EventKind.FUNCTION}
    assert {meaning.kind for meaning in EVENT_CODES.values()} == set(EventKind) - others


def test_functions_have_the_codes_that_the_machine_names():
    codes = CODES | {"M21": "M21", "M10": "M60==1 DWELL0"}
    check_codes(codes, LETTERS)
    assert [code_text(Event(0, EventKind.FUNCTION, number), codes) for number in (21, 10)] == ["M21", "M60==1 DWELL0"]


@pytest.mark.parametrize(
    ("kind", "value", "found"),
    [
        (
            EventKind.TOOL_CHANGE,
            1.5,
            "tool_change 1.5: the code tool_change = 'T{value:d} M6' would write it as 1",
        ),
        (EventKind.TOOL_CHANGE, -1, "tool_change -1: no code has this meaning"),
        (EventKind.SPINDLE, float("inf"), "spindle inf: no code has this meaning"),
        (EventKind.COOLANT, 3, "coolant 3: no code has this meaning"),
        (EventKind.FUNCTION, 21, "function 21: no code has this meaning"),
        # 2^23 - 1 ms, the longest time of a move or dwell (PMAC User Manual, p. 169)
        (EventKind.DWELL, 8388.7, "dwell 8388.7: a dwell lasts 0 to 8388.607 s"),
        (EventKind.DWELL, float("nan"), "dwell nan: a dwell lasts 0 to 8388.607 s"),
    ],
)
def test_an_event_without_code_is_reported_before_writing(kind, value, found):
    event = Event(0, kind, value)
    motion = StrutMotion(np.array([0]), np.full((1, 6), 500.0), np.zeros((1, 6)), (event,))
    assert [(fault.code, fault.found) for fault in event_faults(motion, CODES, "job")] == [("C104", found)]
    with pytest.raises(ValueError, match="expected one with a code"):
        code_text(event, CODES)


def test_a_job_with_codes_for_all_events_has_no_faults(job, settings):
    assert event_faults(job, settings.codes, "job") == ()
