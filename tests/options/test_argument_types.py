# SPDX-License-Identifier: LGPL-2.1-or-later
"""What stands on a command line becomes a finite number, or the user reads what was expected."""

import argparse
import math
import re
import sys

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from pkm_post.cli import main, processes
from pkm_post.options import parse_text
from pkm_post.options.argument_types import (
    above_zero,
    between,
    count,
    number,
    numbered,
    positive,
    validated,
    whole,
    whole_from,
)

FINITE = st.floats(allow_nan=False, allow_infinity=False)
NO_NUMBERS = ["", " ", "x", "1,5", "0x10", "1 2", "--1", "nan", "-NaN", "inf", "-infinity", "1e999"]
NO_DIGITS = [*NO_NUMBERS, "-1", "+1", " 1", "1.0", "1e3", "1_000", "\u00b2", "9" * 5000]
TEN = whole(1, 10)


def refused(convert, text):
    """What the user reads."""
    with pytest.raises(argparse.ArgumentTypeError) as reported:
        convert(text)
    return str(reported.value)


@given(FINITE)
def test_every_finite_number_is_taken_as_it_is_written(value):
    assert number(repr(value)) == value
    if value > 0:
        assert positive(repr(value)) == value
    else:
        assert refused(positive, repr(value)) == f"expected a number above 0, got {repr(value)!r}"


@given(FINITE, FINITE, FINITE)
@example(1.0, 2.0, 1.0)
@example(1.0, 2.0, 2.0)
@example(1.0, 2.0, math.nextafter(2.0, 3.0))
def test_a_number_between_two_includes_both(least, most, value):
    if least <= value <= most:
        assert between(least, most)(repr(value)) == value
    else:
        assert refused(between(least, most), repr(value)).startswith(f"expected a number from {least} to {most}, got")


@given(FINITE, FINITE)
@example(2.0, 2.0)
@example(2.0, math.nextafter(2.0, 3.0))
def test_a_number_above_zero_can_have_an_upper_end(most, value):
    if 0 < value <= most:
        assert above_zero(most)(repr(value)) == value
    else:
        assert refused(above_zero(most), repr(value)).startswith(f"expected a number above 0 and up to {most}, got")


@given(st.integers(0, 50), st.integers(0, 50), st.integers(0, 50))
def test_whole_numbers_in_a_range_and_from_one_on(least, most, value):
    for convert, fits in ((whole(least, most), least <= value <= most), (whole_from(least, "more"), value >= least)):
        if fits:
            assert convert(str(value)) == value
        else:
            assert refused(convert, str(value)).endswith(f", got '{value}'")


@pytest.mark.parametrize("text", NO_NUMBERS)
def test_what_is_no_finite_number_is_refused(text):
    assert refused(number, text) == refused(positive, text) == f"expected a number, got {text!r}"
    assert refused(between(-1, 1), text) == f"expected a number from -1 to 1, got {text!r}"


@pytest.mark.parametrize("text", NO_DIGITS)
def test_what_has_more_than_digits_is_no_whole_number(text):
    assert refused(count, text) == f"expected a whole number above 0, got {text!r}"
    assert refused(TEN, text) == f"expected a whole number from 1 to 10, got {text!r}"


def test_a_count_begins_at_one():
    assert count("1") == 1 and count("007") == 7
    assert refused(count, "0") == "expected a whole number above 0, got '0'"


def test_ranges_can_be_reported_in_other_words():
    assert refused(whole(0, 65_535, "a port"), "65536") == "expected a port from 0 to 65535, got '65536'"
    assert refused(whole_from(1000, "1000 words or more"), "999") == "expected 1000 words or more, got '999'"
    even = validated(TEN, lambda value: value % 2 == 0, "an even number")
    assert even("4") == 4
    assert refused(even, "3") == "expected an even number, got '3'"
    assert refused(even, "12") == "expected a whole number from 1 to 10, got '12'"


@given(st.integers(0, 10**9), FINITE)
def test_a_pair_is_taken_apart(tool, value):
    assert numbered(number, "NUMBER=MM")(f"{tool}={value!r}") == (tool, value)


@pytest.mark.parametrize("text", ["", "=", "=5", "120", "T1=120", "-1=5", "1.0=5", " 1=5", "9" * 5000 + "=5"])
def test_what_is_no_pair_is_refused(text):
    assert refused(numbered(positive, "NUMBER=MM"), text) == f"expected NUMBER=MM, got {text!r}"


@pytest.mark.parametrize(
    ("value", "expected"),
    [("", "a number"), ("5=6", "a number"), ("inf", "a number"), ("0", "a number above 0"), ("-5", "a number above 0")],
)
def test_the_value_of_a_pair_is_reported_by_itself(value, expected):
    assert refused(numbered(positive, "NUMBER=MM"), f"1={value}") == f"expected {expected}, got {value!r}"


@pytest.mark.parametrize("convert", [number, count, between(0, 1), TEN, numbered(positive, "NUMBER=MM")])
def test_the_user_reads_it_beside_the_name_of_the_argument(convert, capsys):
    parser = argparse.ArgumentParser()
    parser.add_argument("--argument", type=convert)
    with pytest.raises(SystemExit) as ended:
        parser.parse_args(["--argument", "many"])
    assert ended.value.code == 2
    assert re.search(r"error: argument --argument: expected .*, got 'many'\n$", capsys.readouterr().err)


USAGE = [
    ("post a.ngc --machne=x", " post: error U101: ", "--machne=x, perhaps --machine or --machine-zero; "),
    ("post a.ngc --machin x", " post: error U101: ", "--machin may be --machine, --machine-zero; "),
    ("pst a.ngc", ": error U101: ", "got 'pst', perhaps post; "),
    ("pmac prob", " pmac: error U101: ", "got 'prob', perhaps probe; "),
    ("--verison", ": error U101: ", "--verison, perhaps --version; "),
    ("verify a.pmc --agianst x", " verify: error U101: ", "--agianst, perhaps --against; "),
    ("verify", " verify: error U102: ", "missing: PROGRAM.pmc, --against; "),
    ("pmac simulate", " pmac simulate: error U102: ", "missing: one of --pty --tcp --ssh; "),
    ("post a.ngc --out", " post: error U102: ", "missing: the value of --out; "),
    ("post a.ngc --find-place=3", " post: error U103: ", "--find-place: expected no value, got '3'; "),
    ("post a.ngc --corners cord", " post: error U103: ", "expected one of chord, arc, got 'cord', perhaps chord; "),
    (
        "pmac jog --port tcp:h --machine m --strut 7",
        " pmac jog: error U103: ",
        "--strut: expected one of 1, 2, 3, 4, 5, 6, got 7; ",
    ),
    ("pmac simulate --pty --tcp 1", " pmac simulate: error U103: ", "--tcp: not allowed with argument --pty; "),
]


if sys.version_info < (3, 14):  # later versions take -1,2,3 for a value
    USAGE.append(
        ("post a.ngc --work-offset -1,2", " post: error U102: ", "of --work-offset; write --work-offset=-1,2; ")
    )


@pytest.mark.parametrize(("words", "start", "found"), USAGE)
def test_usage_faults_have_a_code_and_name_what_may_be_meant(words, start, found, capsys):
    with pytest.raises(SystemExit) as ended:
        main(words.split())
    (line,) = capsys.readouterr().err.splitlines()
    assert ended.value.code == 2
    assert line.startswith(f"python3 -m pkm_post{start}") and found in line


@pytest.mark.parametrize("words", ["--machne=x", "--corners cord", "--out", "extra"])
def test_the_arguments_of_a_job_are_explained_likewise(words):
    with pytest.raises(ValueError, match="(perhaps --machine|perhaps chord|--out|extra).* in "):
        parse_text(words)


@pytest.mark.parametrize("command", ["post", "reach", "stiffness"])
def test_files_that_are_not_read_are_refused_before_freecad_is_started(command, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(processes, "command_inside", pytest.fail)
    (tmp_path / "folder.ngc").mkdir()
    assert main([command, str(tmp_path / "part.stp"), str(tmp_path / "folder.ngc")]) == 2
    unread, folder = capsys.readouterr().err.splitlines()
    assert "part.stp: error F122: files with this ending are not read: expected one of .FCStd, .FCBak, .ngc, " in unread
    assert "folder.ngc: error F103: the file cannot be read: it is a folder; " in folder
    assert main([command, str(tmp_path / "none.FCStd")]) == 1
    assert "none.FCStd: error J101: " in capsys.readouterr().err


@pytest.mark.parametrize("words", ["check {}", "convert {} --to gcode:BC --out new.ngc", "post {}"])
def test_part_programs_that_are_not_read_are_refused_alike(words, tmp_path, capsys):
    def refused(name):
        code = main([str(tmp_path / name) if word == "{}" else word for word in words.split()])
        return code, "".join(capsys.readouterr())

    (tmp_path / "folder.ngc").mkdir()
    for name, expected, found in (
        ("part.stp", 2, "part.stp: error F122: files with this ending are not read: expected one of "),
        ("folder.ngc", 2, "folder.ngc: error F103: the file cannot be read: it is a folder; "),
        ("none.ngc", 1, "none.ngc: error F103: the file cannot be read: there is no such file or folder; "),
    ):
        code, printed = refused(name)
        assert code == expected and found in printed
    code, printed = refused("none.FCStd")
    expected = (1, "J101") if words.startswith("post") else (2, "F122")
    assert (code, f"none.FCStd: error {expected[1]}: " in printed) == (expected[0], True)


@pytest.mark.parametrize(
    ("words", "pattern", "text"),
    [
        ("--tip-tolerance fine", "a number from {} to {}", "a number from 1e-06 to 100"),
        ("--spin up", "one of {}", "one of zero, file, "),
        ("--also pdf", "names out of {}", "names out of csv, "),
    ],
)
def test_what_was_expected_is_a_phrase_for_windows(words, pattern, text):
    with pytest.raises(ValueError, match="expected") as refused:
        parse_text(words)
    expected = refused.value.args[0].named["fault"].named["expected"]
    assert expected.pattern == pattern and expected.startswith(text)
