# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Power PMAC: what it has in common with the Turbo PMAC is tested there."""

import re
from dataclasses import replace

import numpy as np
import pytest
from controller_settings import settings_for

from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.writing.controllers import pmac
from pkm_post.writing.controllers.power_pmac import faults, program_parts, program_text, read_parts, setup_text

SETTINGS = settings_for("power_pmac")
FILE = "job.pmc"

# The words are those of the Power PMAC User's Manual, pp. 670, 706, 724, 778: open prog empties the buffer, so there is
# no clear; comments begin with //, a semicolon only parts statements; pvt alone states the time of PVT moves.
JOB = """\
// job
open prog 10
abs
frax(A,B,C,U,V,W)
linear
ta500 ts0 F10
A512.000000 B513.000000 C514.000000 U515.000000 V516.000000 W517.000000
dwell0
T3 M6
S1200 M3
M8
pvt20
A512.062500:3.1250 B513.062500:3.1250 C514.062500:3.1250 U515.062500:3.1250 V516.062500:3.1250 W517.062500:3.1250
A512.125000:0.0000 B513.125000:0.0000 C514.125000:0.0000 U515.125000:0.0000 V516.125000:0.0000 W517.125000:0.0000
dwell0
M7
dwell500
dwell0
M0
M1
S850.5 M4
pvt1000
A511.500000:0.0000 B512.500000:0.0000 C513.500000:0.0000 U514.500000:0.0000 V515.500000:0.0000 W516.500000:0.0000
dwell0
M5
M9
linear
close
"""


def read(text, settings=SETTINGS):
    return read_parts([(FILE, text)], settings)


def test_a_job_with_every_kind_of_event(job):
    assert program_text(job, SETTINGS, ["job"]) == JOB
    assert program_parts(job, SETTINGS, ["job"]) == (JOB,)


def test_what_was_written_reads_back_to_the_printed_decimals():
    rng = np.random.default_rng(20)
    for decimals, speed_decimals in ((6, 4), (9, 9), (3, 2)):
        settings = replace(SETTINGS, length_decimals=decimals, speed_decimals=speed_decimals, line_limit=999)
        speed = rng.normal(0, 30, (200, 6))
        speed[[0, 90, -1]] = 0.0
        time_ms = np.concatenate([[0], np.cumsum(rng.integers(1, 4096, 199))])
        events = (
            Event(0, EventKind.SPINDLE, -1200.5),
            Event(90, EventKind.DWELL, 0.25),
            Event(199, EventKind.STOP, 0.0),
        )
        motion = StrutMotion(time_ms, rng.uniform(300, 1500, (200, 6)), speed, events)
        text = program_text(motion, settings, ["heading"])
        back, found = read(text, settings)
        assert found == ()
        assert np.array_equal(back.time_ms, motion.time_ms)
        assert back.events == motion.events
        np.testing.assert_allclose(back.length, motion.length, rtol=0, atol=0.5001 * 10.0**-decimals)
        np.testing.assert_allclose(back.speed, motion.speed, rtol=0, atol=0.5001 * 10.0**-speed_decimals)
        assert program_text(back, settings, ["heading"]) == text


@pytest.mark.parametrize(
    ("old", "new", "line", "column"),
    [
        ("// job\n", "; job\n", 1, 1),
        ("open prog 10\n", "open prog 10\nclear\n", 3, 1),
        ("open prog 10\n", "open prog 1\n", 2, 11),
        ("abs\n", "", 3, 1),
        ("abs\n", "inc\n", 3, 1),
        ("pvt20\n", "PVT20\n", 12, 1),
        ("pvt20\n", "pvt20.5\n", 12, 6),
        ("ta500 ts0 F10", "ta500 ts0 F100", 6, 1),
        ("A512.062500:3.1250", "A5.120625E2:3.1250", 13, 10),
        ("M8\n", "M8; M9\n", 11, 3),
        ("linear\nclose\n", "linear\n", 28, 1),
    ],
)
def test_a_malformed_program_is_reported_to_the_column(old, new, line, column):
    assert old in JOB
    back, found = read(JOB.replace(old, new, 1))
    assert back is None
    assert (found[0].code, found[0].place.line, found[0].place.column) == ("C101", line, column)


def test_neither_controller_takes_the_program_of_the_other(job):
    turbo = settings_for("turbo_pmac")
    assert read(pmac.program_text(job, turbo, []))[0] is None
    assert pmac.read_program(JOB, turbo, FILE)[0] is None


def test_no_changed_character_goes_unnoticed():
    original = read(JOB)[0]
    rng = np.random.default_rng(5)
    body = JOB.index("open")
    for place in rng.integers(body, len(JOB) - 1, 300):
        other = chr(rng.integers(32, 127))
        if other == JOB[place]:
            continue
        back, found = read(JOB[:place] + other + JOB[place + 1 :])
        same = back is not None and all(
            np.array_equal(getattr(back, name), getattr(original, name)) for name in ("time_ms", "length", "speed")
        )
        assert found or not same or back.events != original.events, (place, other)


def test_lines_that_are_too_long_are_reported():
    found = read(JOB, replace(SETTINGS, line_limit=112))[1]
    assert {fault.code for fault in found} == {"C103"}


def test_an_event_without_code_is_reported_before_writing(job):
    wrong = replace(job, events=(Event(0, EventKind.COOLANT, 3.0),))
    assert [fault.code for fault in faults(wrong, SETTINGS, "job")] == ["C104"]
    assert faults(job, SETTINGS, "job") == ()


def test_memory_has_no_meaning_here():
    assert not hasattr(SETTINGS, "memory_words")


def _commands(text):
    return [line.split(" //")[0] for line in text.splitlines() if not line.startswith("//")]


def test_the_set_up_of_a_machine():
    # motor units = 10000 * (length - 500): -5000000 at length zero, and the stroke in motor units
    text = setup_text(SETTINGS, "Säule", (450.0, 700.25))
    assert text.startswith("// Set-up of S\\xe4ule\n")
    assert _commands(text) == [
        "&1",
        *(f"#{motor}->10000{letter}-5000000" for motor, letter in enumerate("ABCUVW", start=1)),
        "Coord[1].FeedTime=1000",
        "Coord[1].SegMoveTime=0",
        "Coord[1].NoBlend=0",
        "Coord[1].pDesTimeBase=Coord[1].DesTimeBase.a",  # the default, as in pp_save.cfg of a published project
        *(f"Coord[1].PosRollover[{index}]=0" for index in range(3)),
        *(f"Motor[{motor}].{end}" for motor in range(1, 7) for end in ("MaxPos=2002500", "MinPos=-500000")),
    ]


def test_the_elements_follow_coordinate_system_and_letters():
    text = setup_text(replace(SETTINGS, coordinate_system=12, letters=tuple("UVWXYC")), "m", (450.0, 700.0))
    assert {"&12", "#4->10000X-5000000", "Coord[12].FeedTime=1000", "Coord[12].PosRollover[2]=0"} < set(_commands(text))
    assert len(re.findall("PosRollover", text)) == 1


def test_a_falling_count_turns_the_limits_round():
    text = setup_text(replace(SETTINGS, counts_per_mm=-2.5), "m", (499.0, 501.0))
    assert {"#1->-2.5A+1250", "Motor[1].MaxPos=2.5", "Motor[1].MinPos=-2.5"} < set(_commands(text))


@pytest.mark.parametrize(
    ("units_per_mm", "stroke", "most", "least"),
    [
        (10000.0, (499.99992, 500.00018), "1", "0"),
        (-10000.0, (499.99982, 500.00012), "1", "-1"),
        (1.0, (450.20004, 700.60006), "200.6", "-49.7999"),  # a motor unit is a millimetre
        (0.001, (600.0, 1400.0), "0.9", "0.1"),  # a metre: whole units would be from 1 to 0, and off
        (-0.001, (600.0, 1400.0), "-0.1", "-0.9"),
        (0.2, (499.9999999, 700.0), "40", "0"),  # a turn of 5 mm
    ],
)
def test_limits_are_cut_inward_by_less_than_a_tenth_of_a_micrometre(units_per_mm, stroke, most, least):
    text = setup_text(replace(SETTINGS, counts_per_mm=units_per_mm), "m", stroke)
    assert {f"Motor[1].MaxPos={most}", f"Motor[1].MinPos={least}"} < set(_commands(text))


def test_one_limit_may_be_zero():
    # the limits are off only while both are 0 (Power PMAC User's Manual, p. 430)
    assert "Motor[1].MinPos=0" in _commands(setup_text(SETTINGS, "m", (500.0, 700.0)))


@pytest.mark.parametrize("stroke", [(700.0, 450.0), (450.0, 450.0), (450.0, float("inf"))])
def test_a_stroke_that_is_none_is_refused(stroke):
    with pytest.raises(ValueError, match="stroke: expected two finite lengths"):
        setup_text(SETTINGS, "m", stroke)
