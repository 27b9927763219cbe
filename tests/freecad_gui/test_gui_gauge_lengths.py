# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gauge lengths in the post panel, in a FreeCAD with a window.

Of two tools the first is in use and has none at first; the second has 102 mm.
"""

import shlex

import pytest

ROUNDING = 1e-9
"""mm: of a length that was typed."""
SENSELESS = ("abc", "5 deg", "-120 mm", "12,5 cm", "0")


@pytest.fixture(scope="module")
def session(scene):
    return scene("gauge_lengths")


def test_missing_length_is_reported_before_and_by_posting(session):
    found = session["missing_length_is_reported_as_posting_tells_it"]
    assert [(number, bit) for number, _, bit in found["cells"]] == [("1", "50 mm"), ("2", "50 mm")]
    assert found["cells"][1][1] == "TC2"
    assert (found["texts"], found["hint"]) == (["", "102 mm"], "unknown")
    assert "J113" in found["notes"] and "Gauge lengths" in found["notes"]
    assert found["reported"] == [found["notes"]]
    assert (found["files"], found["lengths"]) == ([], [None, 102])
    assert session.drew("missing.png")


def test_inches_are_shown_in_mm_posted_and_undone_in_one_step(session):
    found = session["inches_are_typed_and_posted"]
    assert (found["texts"], found["notes"]) == (["114.3 mm", "102 mm"], "")
    assert found["before"] == [None, 102]
    assert found["verdict"].startswith("Certified")
    assert found["lengths"] == [pytest.approx(4.5 * 25.4, abs=ROUNDING), 102]
    assert not any(word.startswith("--tool-length") for word in shlex.split(found["arguments"]))
    assert found["steps"] == 1
    assert found["undone"] == [[None, 102], ["", "102 mm"], True]
    assert found["arguments undone"] == "--work-offset=0,0,250"
    assert found["redone"] == [[found["lengths"][0], 102], ["114.3 mm", "102 mm"], ""]


def test_number_alone_has_the_unit_of_the_window(session):
    found = session["number_alone_has_the_unit_of_the_window"]
    assert found["before"] == ["", "4.01574803 in"]  # 102 / 25.4, nine digits
    assert found["shown"][0] == "4.5 in"
    assert found["kept"] == [pytest.approx(4.5 * 25.4, abs=ROUNDING), 102]  # what was not typed over is exact


@pytest.mark.parametrize("text", SENSELESS)
def test_what_is_no_length_is_reported_and_left_to_be_corrected(session, text):
    found = session["what_is_no_length_is_reported_and_not_kept"][text]
    assert found["text"] == text
    assert f"T1, {text!r} is not a length above zero" in found["notes"]
    assert found["reported"] == found["applied"] == [found["notes"]]


def test_nothing_is_kept_beside_what_is_no_length(session):
    assert session["what_is_no_length_is_reported_and_not_kept"]["document"] == [[None, 102], 0, True, []]


def test_lengths_are_kept_and_taken_back_without_posting(session):
    found = session["lengths_are_kept_without_posting"]
    assert found["lengths"] == [118.75, 0]
    assert (found["steps"], found["again"]) == (1, 1)
    assert found["reported"].startswith("Stored")
    assert found["files"] == []
    assert "--machine=example_6tps" in shlex.split(found["machine"])


def test_simulation_has_what_was_typed(session):
    found = session["simulation_has_what_was_typed"]
    assert found == {"lengths": [110, 102], "followable": True, "valid": True}


def test_arguments_go_before_the_field_and_that_is_reported(session):
    found = session["arguments_go_before_the_field"]
    assert "T1: 130 mm" in found["notes"] and "J113" not in found["notes"]
    assert found["verdict"].startswith("Certified")
    assert found["lengths"] == [None, 102]
    assert "J113" in found["without"]


def test_table_follows_the_document_and_writes_what_was_typed_alone(session):
    found = session["table_follows_the_document"]
    assert found["changed"] == ["100 mm", "95 mm"]
    assert found["more"][0] == ["100 mm", "95 mm", "103 mm"]
    assert found["more"][1][1:] == ["Ball", "TC3"]
    assert found["kept"] == [100, 96, 103]
    assert found["shown"] == ["100 mm", "96 mm", "103 mm"]
    assert found["closed"] == [100, 96, 103]


def test_numbers_have_the_comma_of_the_language(session):
    assert session["numbers_have_the_comma_of_the_language"] == {
        "typed": "120,5 mm",
        "length": ["2,50 mm", "2,499 mm", "150,000 mm"],
        "time": ["2,3 s", "1:02,5"],
        "angles": ["22,5; 90", [22.5, 45.5]],
    }


def test_a_comma_that_is_no_decimal_separator_is_not_read(session):
    assert session["a_comma_that_is_no_decimal_separator_is_not_read"]["angles"] == [30.0]
