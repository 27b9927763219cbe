# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gauge lengths of a job: what its tool controllers say, what posting would say of them, and what they keep."""

import pytest
from cam_jobs import add_operation, add_tool_controller, reopened

from pkm_post.freecad_app.gauge_lengths import store_gauge_lengths, tool_rows
from pkm_post.freecad_app.job import read_job


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


def test_unknown_length_is_told_as_posting_tells_it(two):
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
