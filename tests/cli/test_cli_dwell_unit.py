# SPDX-License-Identifier: LGPL-2.1-or-later
"""The unit of dwells by the command line and from a macro: what is reported, and what is posted."""

import numpy as np
import pytest

from pkm_post import post
from pkm_post.cli import main
from pkm_post.options.choices import Options
from pkm_post.reading.part_program import ReadingOptions

PROGRAM = "G21 F600\nG0 X0 Y0 Z5\nG82 X1 Z4 R5 P250\nG4 P1000\nG1 X2\nM2\n"
POSTED = ["--tool-length", "0=120", "--work-offset=0,0,250"]


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "part.ngc"
    path.write_text(PROGRAM)
    return path


def dwells(program):
    """The dwells of a motion program in ms, without those of 0 that stop the lookahead."""
    words = [line.split()[0] for line in program.read_text().splitlines() if line.startswith("DWELL")]
    return [word.removeprefix("DWELL") for word in words if word != "DWELL0"]


@pytest.mark.parametrize(("arguments", "reported"), [((), 2), (("--dwell-unit", "ms"), 0), (("--dwell-unit=s",), 2)])
def test_check_tells_long_dwells(file, capsys, arguments, reported):
    assert main(["check", str(file), *arguments]) == 0
    assert capsys.readouterr().out.count("warning G428") == reported


@pytest.mark.parametrize(
    ("unit", "written"), [("s", ["G4 P250.0000", "G4 P1000.0000"]), ("ms", ["G4 P0.2500", "G4 P1.0000"])]
)
def test_convert_writes_seconds(file, tmp_path, unit, written):
    out = tmp_path / "out.ngc"
    assert main(["convert", str(file), "--to", "gcode:3axis", "--out", str(out), "--dwell-unit", unit]) == 0
    assert [line for line in out.read_text().splitlines() if line.startswith("G4 ")] == written


def test_what_is_posted_waits_as_long_as_was_said(file, tmp_path, capsys):
    assert main(["post", str(file), "--out", str(tmp_path), "--dwell-unit", "ms", *POSTED]) == 0
    assert "G428" not in capsys.readouterr().err
    assert dwells(tmp_path / "part.pmc") == ["250", "1000"]
    offset = np.eye(4)
    offset[2, 3] = 250.0
    reading, options = ReadingOptions(dwell_unit="ms"), Options(work_offset=offset)
    post(file, out=tmp_path / "macro", reading=reading, options=options, tool_lengths={0: 120.0})
    assert (tmp_path / "macro" / "part.pmc").read_bytes() == (tmp_path / "part.pmc").read_bytes()


def test_reach_takes_it_as_well(file, capsys):
    assert main(["reach", str(file), "--dwell-unit", "ms", *POSTED]) == 0
    assert "G428" not in capsys.readouterr().err
    assert main(["reach", str(file), *POSTED]) == 0
    assert capsys.readouterr().err.count("warning G428") == 2


def test_another_word_is_refused(file, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["check", str(file), "--dwell-unit", "min"])
    expected = "error U103: an argument is not valid: --dwell-unit: expected one of s, ms, got 'min'"
    assert ended.value.code == 2 and expected in capsys.readouterr().err
