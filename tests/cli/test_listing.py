# SPDX-License-Identifier: LGPL-2.1-or-later
"""``check --listing``: every line of the source with what was found beneath it, at its column, and the counts."""

import json
import tracemalloc

import pytest

from pkm_post.cli import main
from pkm_post.model import Diagnostic, Place
from pkm_post.reading import listing_lines
from pkm_post.reading.check import CheckedFile, check_file

MARGIN = " " * 10


def saved(path, text):
    path.write_bytes(text.encode("utf-8"))
    return path


def test_a_caret_is_beneath_the_first_line_after_a_byte_order_mark(tmp_path, capsys):
    file = saved(tmp_path / "part.ngc", "\ufeffG0 X?\nM2\n")
    assert main(["check", str(file)]) == 1
    assert capsys.readouterr().out.splitlines()[1:3] == ["    G0 X?", "        ^"]


def test_faults_stand_beneath_their_columns(tmp_path, capsys):
    file = saved(tmp_path / "part.ngc", "\ufeffG0 X0 Y0 Z0\r\nG1\tX1..5 F100\r\nM2\r\n")
    assert main(["check", "--listing", str(file)]) == 1
    listed = capsys.readouterr().out.splitlines()
    assert listed[:4] == ["       1  G0 X0 Y0 Z0", "       2  G1 X1..5 F100", f"{MARGIN}    ^", listed[3]]
    assert listed[3].startswith(f"{MARGIN}error G102: a number is malformed: ")
    assert (listed[4], listed[-1]) == ("       3  M2", f"{file}: 3 lines, 1 error, 0 warnings")


def test_several_faults_of_a_line_are_in_the_order_of_their_columns(tmp_path):
    file = saved(tmp_path / "part.cl", "GOTO/1,2,3\n")
    places = [Place(str(file), line=1, column=column) for column in (6, 1, 0)]
    found = tuple(Diagnostic(code, place, "x") for code, place in zip(("L402", "L404", "L410"), places, strict=True))
    listed = list(listing_lines(CheckedFile(file, None, found)))
    assert [line.split()[1] for line in listed if "error" in line[:20] or "warning" in line[:20]] == [
        "L410:", "L404:", "L402:"]  # fmt: skip
    assert [line for line in listed if line.endswith("^")] == [f"{MARGIN}^", f"{MARGIN}     ^"]
    assert listed[-1] == f"{file}: 1 lines, 1 error, 2 warnings"


def test_what_has_no_line_in_the_file_comes_at_the_end(tmp_path):
    file = saved(tmp_path / "part.cl", "FINI\n")
    places = [Place(str(file)), Place("other.ngc", line=1, column=1), Place(str(file), line=9)]
    found = tuple(Diagnostic("L402", place, "x") for place in places)
    listed = list(listing_lines(CheckedFile(file, None, found)))
    assert listed[0] == "       1  FINI"
    assert listed[1:4] == [str(found[0]), str(found[1]), str(found[2])]


def test_long_and_unprintable_lines_are_shown_in_part(tmp_path):
    file = saved(tmp_path / "part.ngc", f"(a\x07b)\nG1 {'X1 ' * 100}\nM2\n")
    found = (Diagnostic("G102", Place(str(file), line=2, column=250), "x"),)
    listed = list(listing_lines(CheckedFile(file, None, found)))
    assert listed[0] == "       1  (a?b)"
    assert listed[1].endswith(" ...") and len(listed[1]) == len(MARGIN) + 204
    assert listed[2] == f"{MARGIN}in column 250:"


@pytest.mark.parametrize("end", ["\n", "\r", "\r\n"])
def test_lines_are_counted_as_the_readers_count_them(tmp_path, end):
    file = saved(tmp_path / "part.ngc", end.join(["G0 X0 Y0 Z0", "", "G1 X1..5 F100", "M2", ""]))
    listed = list(listing_lines(check_file(file)))
    assert listed[2] == "       3  G1 X1..5 F100"
    assert listed[3] == f"{MARGIN}    ^"


def test_a_large_file_is_not_held_in_memory(tmp_path):
    file = saved(tmp_path / "part.ngc", "G1 X1 Y2 Z3 F100\n" * 40_000)
    tracemalloc.start()
    count = sum(1 for _ in listing_lines(CheckedFile(file, None, ())))
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert (count, most < 200_000) == (40_001, True)


def test_json_is_as_without_a_listing_and_both_are_refused(tmp_path, capsys):
    file = saved(tmp_path / "part.ngc", "G1 X1..5 F100\nM2\n")
    assert main(["check", "--json", str(file)]) == 1
    assert json.loads(capsys.readouterr().out)[0]["diagnostics"][0]["code"] == "G102"
    with pytest.raises(SystemExit):
        main(["check", "--json", "--listing", str(file)])
