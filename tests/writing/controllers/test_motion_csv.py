# SPDX-License-Identifier: LGPL-2.1-or-later
import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from pkm_post.model import StrutMotion
from pkm_post.writing.controllers.motion_csv import measured, read_table, texts


def same(first, second):
    columns = ("time_ms", "length", "speed")
    return all(np.array_equal(getattr(first, name), getattr(second, name)) for name in columns)


@pytest.mark.parametrize("knots", [1, 2, 5000])
def test_what_was_written_is_read_back_bit_for_bit(knots):
    rng = np.random.default_rng(knots)
    speed = rng.normal(0, 30, (knots, 6)) * 10.0 ** rng.integers(-12, 1, (knots, 6))
    motion = StrutMotion(np.arange(knots) * 3, rng.uniform(300, 1500, (knots, 6)), speed, ())
    (text,) = texts(motion, ["heading"])
    read, faults = read_table(text, "job.csv")
    assert faults == ()
    assert same(read, motion)
    assert measured([("job.csv", text)], motion) == (f"{knots} rows", ())


def test_events_come_back_at_their_knots(job):
    read, faults = read_table(texts(job, [])[0], "job.csv")
    assert faults == ()
    assert read.events == job.events


def test_any_program_for_tables_can_read_it(job):
    rows = list(csv.DictReader(io.StringIO(texts(job, [])[0])))
    assert [row["time_ms"] for row in rows] == ["0", "20", "40", "1040"]
    assert [float(row["length_6_mm"]) for row in rows] == [517.0, 517.0625, 517.125, 516.5]
    assert [float(row["speed_1_mm_s"]) for row in rows] == [0.0, 3.125, 0.0, -1e-05]
    assert rows[0]["events"] == "tool_change=3.0;spindle=1200.0;coolant=1.0"
    assert rows[1]["events"] == ""


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("time_ms", "time", 1),
        ("512.0625", "512,0625", 3),
        ("512.0625", "nan", 3),
        ("512.0625", "1e400", 3),
        ("512.0625", "9" * 400, 3),
        ("spindle=1200.0", "spindle=1e999", 2),
        ("\n1040,", "\n99999999999999999999,", 5),
        ("512.0625", "", 3),
        ("3.125,\n", "3.125\n", 3),
        ("tool_change", "toolchange", 2),
        ("spindle=1200.0", "spindle=", 2),
        ("\n40,", "\n10,", 4),
        ("\n1040,", "\n40,", 5),
    ],
)
def test_a_table_that_was_changed_is_reported_to_the_line(job, old, new, line):
    (text,) = texts(job, [])
    assert old in text
    read, faults = read_table(text.replace(old, new, 1), "job.csv")
    assert read is None
    assert [(fault.code, fault.place.line) for fault in faults] == [("C106", line)]


@pytest.mark.parametrize("text", ["", "\n", "time_ms\n"])
def test_what_is_no_table_is_reported(text):
    assert read_table(text, "job.csv")[1][0].code == "C106"


def test_a_table_cut_off_within_a_line_is_a_fault(job):
    (text,) = texts(job, [])
    assert read_table(text[:-1], "job.csv")[1]
    assert read_table(text[: text.index("\n") + 1], "job.csv")[1]


def test_a_digit_that_was_changed_is_measured(job):
    (text,) = texts(job, [])
    reported, faults = measured([("job.csv", text.replace("512.0625", "512.0626"))], job)
    assert (reported, [fault.code for fault in faults]) == ("", ["C107"])


def test_numbers_that_are_not_finite_are_refused(job):
    with pytest.raises(ValueError, match="expected finite"):
        texts(replace(job, length=np.full((4, 6), np.nan)), [])
