# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gauge lengths of a job: what its tool controllers say, what posting would say of them, and what they keep.

Typed lengths mean what people mean by them, or nothing; what is shown is read back as it was.
"""

import FreeCAD as App
import pytest
from cam_jobs import add_operation, add_tool_controller, reopened

from pkm_post.freecad_app.gauge_lengths import format_length, parse_length, store_gauge_lengths, tool_rows
from pkm_post.freecad_app.job import read_job

MILLIMETRES, INCHES = 6, 3
"""Unit schemes of FreeCAD: metric small parts and CNC, imperial decimal."""
ROUNDING = 5e-9
"""Of lengths, relative; they are shown with nine digits."""


@pytest.fixture
def two(job):
    """A job with two tools; the first is used, the second has no gauge length."""
    add_operation(job)
    add_tool_controller(job, 2).removeProperty("GaugeLength")
    return job


def test_rows_say_what_the_tool_controllers_say(two):
    first, second = tool_rows(two)
    one, other = two.Tools.Group
    assert (first.name, first.number, first.label, first.length) == (one.Name, 1, one.Label, 120)
    assert (second.name, second.number, second.label, second.length) == (other.Name, 2, "TC2", 0)
    assert (first.bit_length, second.bit_length) == (one.Tool.Length.Value, other.Tool.Length.Value)
    assert first.bit_length > 0


def test_tool_is_in_use_while_an_active_operation_takes_it(two):
    operation = two.Operations.Group[0]
    assert [row.in_use for row in tool_rows(two)] == [True, False]
    operation.ToolController = two.Tools.Group[1]
    assert [row.in_use for row in tool_rows(two)] == [False, True]
    operation.Active = False
    assert [row.in_use for row in tool_rows(two)] == [False, False]


def test_unknown_length_is_reported_as_posting_tells_it(two):
    two.Operations.Group[0].ToolController = two.Tools.Group[1]
    two.Document.recompute()
    _, row = tool_rows(two)
    assert (row.missing_length(),) == read_job(two)[1]
    assert "Gauge lengths" in str(row.missing_length())
    assert row.missing_length("'abc' is no length").found == "T2, 'abc' is no length"


def test_lengths_are_kept_in_one_step_and_saved(two, tmp_path):
    document, names = two.Document, [row.name for row in tool_rows(two)]
    document.UndoMode = 1
    document.openTransaction("Gauge lengths")
    store_gauge_lengths(two, {names[0]: 118.75, names[1]: 95.0})
    document.commitTransaction()
    assert [row.length for row in tool_rows(two)] == [118.75, 95]
    document.undo()
    assert [row.length for row in tool_rows(two)] == [120, 0]
    document.redo()
    again = reopened(document, tmp_path / "kept.FCStd").getObject("Job")
    assert [row.length for row in tool_rows(again)] == [118.75, 95]


def test_lengths_that_are_the_same_or_not_named_are_not_touched(two):
    two.Document.recompute()
    names = [row.name for row in tool_rows(two)]
    store_gauge_lengths(two, {names[0]: 120.0, names[1]: 0.0, "NoSuchController": 50.0})
    assert "Touched" not in two.Tools.Group[0].State
    assert not hasattr(two.Tools.Group[1], "GaugeLength")
    store_gauge_lengths(two, {})
    assert [row.length for row in tool_rows(two)] == [120, 0]


def test_length_can_be_taken_back(two):
    store_gauge_lengths(two, {tool_rows(two)[0].name: 0.0})
    assert [fault.code for fault in read_job(two)[1]] == ["J113"]


@pytest.mark.parametrize("mm", [-1.0, float("nan")])
def test_length_below_zero_is_the_callers_fault(two, mm):
    first, second = tool_rows(two)
    with pytest.raises(ValueError, match="expected gauge lengths of 0 or more"):
        store_gauge_lengths(two, {first.name: 50.0, second.name: mm})
    assert [row.length for row in tool_rows(two)] == [120, 0]


def test_tool_controller_without_a_bit_has_a_row(two):
    two.Tools.Group[1].Tool = None
    assert tool_rows(two)[1].bit_length == 0


@pytest.fixture
def units():
    """Sets the unit scheme, and at the end the one that it was."""
    before = App.ParamGet("User parameter:BaseApp/Preferences/Units").GetInt("UserSchema", 0)
    yield App.Units.setSchema
    App.Units.setSchema(before)


@pytest.mark.parametrize(
    ("text", "mm"),
    [
        ("120", 120), (" 120 mm ", 120), ("12 cm", 120), ("0.12 m", 120), ("3*40 mm", 120), ("120000 µm", 120),
        ("4.5 in", 114.3), ('4.5"', 114.3), ("4' 2\"", 1270), ("118.75", 118.75),
    ],
)  # fmt: skip
def test_length_with_or_without_its_unit(units, text, mm):
    units(MILLIMETRES)
    assert parse_length(text) == pytest.approx(mm, rel=ROUNDING)


def test_number_alone_is_in_the_unit_that_lengths_are_shown_in(units):
    units(INCHES)
    assert parse_length("4.5") == pytest.approx(114.3, rel=ROUNDING)
    assert parse_length("120 mm") == pytest.approx(120, rel=ROUNDING)


@pytest.mark.parametrize(
    "text",
    [
        "", " ", "abc", "0", "0 mm", "-120 mm", "5 deg", "120 mm/s", "120 mm^2", "1/0", "nan", "inf", "1e999 mm",
        "4 1/2 in", "120 mm mm", "12,5 cm", "1e9", "10001 mm", "1,200 mm", "120 毫米", "１２０", "120000 μm",
    ],
)  # fmt: skip
def test_what_is_no_length_above_zero_has_no_meaning(units, text):
    for scheme in (MILLIMETRES, INCHES):
        units(scheme)
        assert parse_length(text) is None


def test_decimal_point_of_the_language_and_the_full_stop():
    assert parse_length("120,5 mm", ",") == pytest.approx(120.5, rel=ROUNDING)
    assert parse_length("120.5 mm", ",") == pytest.approx(120.5, rel=ROUNDING)
    assert parse_length("1.200,5 mm", ",") is None


def test_length_is_shown_in_the_unit_that_is_set(units):
    units(MILLIMETRES)
    assert (format_length(120.0), format_length(118.75125)) == ("120 mm", "118.75125 mm")
    assert format_length(120.5, ",") == "120,5 mm"
    units(INCHES)
    assert format_length(114.3) == "4.5 in"


@pytest.mark.parametrize("point", [".", ","])
def test_what_is_shown_is_read_back_in_every_scheme(units, point):
    for scheme in range(len(App.Units.listSchemas())):
        units(scheme)
        for mm in (0.001234, 7.0, 118.75125, 2540.0):
            assert parse_length(format_length(mm, point), point) == pytest.approx(mm, rel=ROUNDING), scheme
