# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options that mean nothing for what is read are refused; in a batch each is for the files that it fits."""

from pathlib import Path

import pytest
from option_examples import FLAGS, SWITCHES, words

from pkm_post.cli import main
from pkm_post.model import Refused
from pkm_post.options import (
    InputKind,
    applicable_values,
    explicit_values,
    inapplicable_options,
    input_kind,
    parse_text,
    part_program_from,
)
from pkm_post.posting.post_file import _with_typed_options, post_file
from pkm_post.reading import AS_WRITTEN

GCODE = "T1 M6 G43 H1\nG21 G90 G94 S8000 M3\nG0 X0 Y0 Z30\nG4 P10\nG1 X10 Y0 Z20 F600\nG0 Z30\nM2\n"
CLDATA = "UNITS/MM\nLOADTL/1\nRAPID\nGOTO/0,0,30\nFEDRAT/600,MMPM\nGOTO/10,0,20\nRAPID\nGOTO/10,0,30\nFINI\n"
REACHED = ("--tool-length=1=60", "--work-offset=0,0,250")
FOR_CLDATA = ("--contour-data", "--cl-dialect", "--cycle-values", "--cycle-kinds", "--goto-values")
FOR_GCODE = ("--flavour", "--leave-out", "--origin", "--subprograms", "--block-delete", "--delete-switches")
FOR_BOTH = ("--tool", "--tool-table", "--unit", "--feed", "--allow-open-end", "--wear", "--machine-zero")
FOR_JOBS_TOO = {"--origin"}
"""A CAM job may have further fixtures."""
FOR_POSTING = ("--side",)
"""What is asked of part programs, but by the post and not by the reader."""
FOR_PART_PROGRAMS = (*FOR_CLDATA, *FOR_GCODE, *FOR_BOTH)


@pytest.mark.parametrize("flag", FOR_PART_PROGRAMS)
@pytest.mark.parametrize("which", [0, 1])
def test_each_typed_option_of_a_part_program_reaches_its_reader(flag, which):
    typed = parse_text(" ".join(words(flag, which)))
    reading = _with_typed_options(AS_WRITTEN, typed)
    assert reading == part_program_from(typed, "none")
    assert reading != AS_WRITTEN or (flag in SWITCHES and which == 1)


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("a.ngc").write_text(GCODE, encoding="ascii")
    Path("b.apt").write_text(CLDATA, encoding="ascii")
    return tmp_path


def test_files_are_reported_apart_by_their_names():
    reported = [input_kind(Path(name)) for name in ("a.NGC", "a.mpf", "a.cls", "a.CL", "a.FCStd", "a")]
    assert reported == [InputKind.GCODE] * 2 + [InputKind.CLDATA] * 2 + [InputKind.JOB] * 2


@pytest.mark.parametrize("flag", FLAGS)
@pytest.mark.parametrize("source", InputKind)
def test_each_option_fits_or_is_named(flag, source):
    given = explicit_values(parse_text(" ".join(words(flag, 0))))
    unfit = {
        InputKind.GCODE: FOR_CLDATA,
        InputKind.CLDATA: FOR_GCODE,
        InputKind.JOB: {*FOR_PART_PROGRAMS, *FOR_POSTING} - FOR_JOBS_TOO,
    }
    fits = flag not in unfit[source]
    assert [each.split()[0] for each in inapplicable_options(given, {source})] == ([] if fits else [flag])
    assert applicable_values(given, source) == (given if fits else {})
    assert inapplicable_options(given, set(InputKind)) == []


@pytest.mark.parametrize("command", ["check", "convert", "post", "reach"])
@pytest.mark.parametrize(
    ("file", "option", "found"),
    [
        ("a.ngc", "--contour-data=centre", "--contour-data is for CL data"),
        ("a.ngc", "--cl-dialect=nx", "--cl-dialect is for CL data"),
        ("a.ngc", "--cycle-values=depth,feed", "--cycle-values is for CL data"),
        ("b.apt", "--dwell-unit=ms", "--dwell-unit is for G-code"),
        ("b.apt", "--axis-words=AC", "--axis-words is for G-code"),
        ("b.apt", "--flavour=fanuc", "--flavour is for G-code"),
    ],
)
def test_an_option_for_another_kind_of_file_is_refused(files, capsys, command, file, option, found):
    more = {"convert": ["--to=gcode:3axis", "--out=out.nc"], "post": ["--out=out", *REACHED], "reach": REACHED}
    assert main([command, file, option, *more.get(command, [])]) == 2
    reported = capsys.readouterr()
    assert (reported.out, reported.err) == (
        "",
        f"{file}: error L442: an option does not apply to this input: {found}; leave it out\n",
    )
    assert sorted(path.name for path in files.iterdir()) == ["a.ngc", "b.apt"]


def test_a_document_has_nothing_to_be_read_so(files, capsys):
    Path("c.FCStd").write_bytes(b"")
    assert main(["post", "c.FCStd", "--unit=mm", "--allow-open-end"]) == 2
    assert [line.split(": ")[3] for line in capsys.readouterr().err.splitlines()] == [
        "--unit is for G-code and CL data; leave it out",
        "--allow-open-end is for G-code and CL data; leave it out",
    ]
    assert main(["post", "a.ngc", "--job=Job"]) == 2
    assert "--job is for CAM jobs" in capsys.readouterr().err


@pytest.mark.slow
def test_in_a_batch_each_option_is_for_the_files_that_it_fits(files, capsys):
    mixed = ["a.ngc", "b.apt", "--contour-data=centre", "--dwell-unit=ms"]
    assert main(["check", *mixed]) == 0
    assert main(["reach", *mixed, *REACHED]) == 0
    assert main(["post", *mixed, *REACHED, "--jobs=1", "--out=out"]) == 0
    assert {"a.pmc", "b.pmc"} <= {path.name for path in (files / "out").iterdir()}
    capsys.readouterr()
    assert main(["check", "a.ngc", "a.ngc", "--contour-data=centre"]) == 2
    assert capsys.readouterr().err.startswith("arguments: error L442: ")


def test_macros_are_reported_with_what_else_is_wrong(files):
    with pytest.raises(Refused) as refused:
        post_file("a.ngc", out="out", arguments="--contour-data centre --work-offset 0,0,250")
    assert [each.code for each in refused.value.diagnostics] == ["L442", "J113"]
    assert not Path("out").exists()
