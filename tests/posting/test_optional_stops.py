# SPDX-License-Identifier: LGPL-2.1-or-later
"""Optional stops are written, are program stops, or are left out, as the option or the machine file says."""

import pytest

from pkm_post.machine import find_machine
from pkm_post.options import options_from, parse_text
from pkm_post.posting import post_file

WITH_STOPS = """\
T1 M6 G43 H1
G21 G90 G94 S8000 M3
G0 X0 Y0 Z30
G1 X10 Y0 Z20 F600
M1
G0 Z30
M0
M1
M5
M30
"""
WRITTEN = ["M1", "M0", "M1"]
FATES = {
    "": (WRITTEN, ""),
    "--optional-stops written": (WRITTEN, ""),
    "--optional-stops stop": (["M0", "M0", "M0"], "2 optional stops written as program stops, as chosen"),
    "--optional-stops leave-out": (["M0"], "2 optional stops left out, as chosen"),
}


def posted(tmp_path, text, arguments, machine=None):
    """The stops of the written program, and how it was read."""
    part = tmp_path / "part.ngc"
    part.write_text(text, encoding="ascii")
    arguments = f"--work-offset 0,0,250 --tool-length 1=60 {arguments}"
    result = post_file(part, machine, arguments=arguments, out=tmp_path / "out")
    lines = result.program.read_text(encoding="ascii").splitlines()
    return [line for line in lines if line in ("M0", "M1")], result.report["program"]["reading"]


@pytest.mark.slow
@pytest.mark.parametrize("arguments", FATES)
def test_the_option_says_what_becomes_of_them(tmp_path, arguments):
    stops, reading = posted(tmp_path, WITH_STOPS, arguments)
    expected, note = FATES[arguments]
    assert stops == expected
    assert [line for line in reading if "optional stop" in line] == ([note] if note else [])


def test_the_machine_file_says_it_too_and_the_option_goes_before(tmp_path):
    machine = tmp_path / "machine.toml"
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    machine.write_text(text + '\n[part_programs]\noptional_stops = "leave-out"\n', encoding="utf-8")
    assert posted(tmp_path, WITH_STOPS, "", machine)[0] == ["M0"]
    assert posted(tmp_path, WITH_STOPS, "--optional-stops written", machine)[0] == WRITTEN


def test_other_words_are_refused():
    with pytest.raises(ValueError, match="--optional-stops"):
        options_from(parse_text("--optional-stops maybe"))
