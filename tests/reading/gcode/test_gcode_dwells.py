# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dwells: P in seconds, as rs274 has it, or in milliseconds, as the user says."""

import pytest

from pkm_post.model import EventKind
from pkm_post.reading.gcode import ReadOptions, read

HEAD = "G21 F100\nG0 X0 Y0 Z5\n"


def dwells(text, unit):
    program, faults = read(HEAD + text + "\nM2\n", "part.ngc", ReadOptions(dwell_unit=unit))
    diagnostics = [(fault.code, fault.place.line) for fault in faults]
    return program and [event.value for event in program.events if event.kind is EventKind.DWELL], diagnostics


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("G4 P2", 2.0),
        ("G4 P0.25", 0.25),
        ("G82 X1 Z-1 R1 P3", 3.0),
        ("G89 X1 Z-1 R1 P1.5\nX2", 1.5),
        ("M3 S9\nG86 X1 Z-1 R1 P4", 4.0),
    ],
)
def test_p_is_in_seconds_unless_the_user_says_milliseconds(text, seconds):
    """The numbers are what rs274 prints for DWELL."""
    found, diagnostics = dwells(text, "s")
    assert set(found) == {seconds} and diagnostics == []
    whole = text.replace("P0.25", "P250").replace("P1.5", "P1500")
    found, diagnostics = dwells(whole, "ms")
    assert set(found) == {seconds / 1000 if whole == text else seconds} and diagnostics == []


def test_the_same_time_in_both_units_is_the_same_program():
    in_seconds, in_ms = "G82 X1 Z-1 R1 P0.5\nX2\nG4 P2", "G82 X1 Z-1 R1 P500\nX2\nG4 P2000"
    assert dwells(in_seconds, "s") == dwells(in_ms, "ms") == ([0.5, 0.5, 2.0], [])


@pytest.mark.parametrize(("unit", "just", "more"), [("s", "60", "60.001"), ("ms", "60000", "60001")])
@pytest.mark.parametrize("block", ["G4 P{}", "G82 X1 Z-1 R1 P{}"])
def test_more_than_a_minute_is_reported_with_both_readings(unit, just, more, block):
    assert dwells(block.format(just), unit)[1] == []
    found, diagnostics = dwells(block.format(more), unit)
    assert len(found) == 1 and diagnostics == [("G428", 3)]


def test_both_readings_are_in_the_message():
    _, (fault,) = read(f"{HEAD}G4 P1000\nM2\n", "part.ngc")
    assert fault.found == "P1000 in s: 1000 s, or in ms: 1 s" and "--dwell-unit" in str(fault)


@pytest.mark.parametrize("word", ["P2.", "P2.0", "P 2.", "P0.5", "P.5", "p2."])
def test_milliseconds_have_no_point(word):
    """Some controls of milliseconds take a number with a point for seconds."""
    assert dwells(f"G4 {word}", "s")[1] == []
    assert dwells(f"G4 {word}", "ms") == (None, [("G427", 3)])
    assert dwells(f"G82 X1. Z-1. R1. {word}", "ms") == (None, [("G427", 3)])


def test_other_words_may_have_a_point():
    assert dwells("G82 X1. Z-1. R1. P200 (P2.)\nX2.5 ; P3.", "ms") == ([0.2, 0.2], [])
    assert dwells("G64 P0.5\nG2 X2. I1. P2.", "ms") == ([], [])


def test_a_loop_tells_its_dwell_once():
    _, diagnostics = dwells("o1 repeat [5]\nG4 P100\no1 endrepeat", "s")
    assert diagnostics == [("G428", 4)]


def test_another_unit_is_refused():
    with pytest.raises(ValueError, match="dwell_unit"):
        ReadOptions(dwell_unit="min")
