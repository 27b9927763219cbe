# SPDX-License-Identifier: LGPL-2.1-or-later
"""Part programs in files: what `check` says of them and what `convert` makes of them."""

import json
import os
import stat
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from programs import cone, program, random_job, square_with_arc

from pkm_post.cli import _parser, main
from pkm_post.model import Kind, Tool
from pkm_post.model.diagnostics import errors
from pkm_post.reading.check import check_file, size_of
from pkm_post.reading.part_program import ReadingOptions, read_part_program
from pkm_post.writing.conversion import TARGETS, convert
from pkm_post.writing.gcode import GcodeDialect, write

MICRON = 1e-3
AXIS_WORDS = {
    GcodeDialect.VECTOR: "vector",
    GcodeDialect.AC: "AC",
    GcodeDialect.BC: "BC",
    GcodeDialect.LINUXCNC: "RPY",
    GcodeDialect.PLAIN: "none",
}


def saved(file, text):
    file.write_text(text, encoding="ascii")
    return file


@pytest.mark.parametrize("target", TARGETS)
def test_a_converted_file_holds_the_same_motion(tmp_path, target):
    given = square_with_arc() if target == "gcode:3axis" else random_job(np.random.default_rng(2))
    source = saved(tmp_path / "part.ngc", write(given, GcodeDialect.BC)[0])
    out = tmp_path / "new" / "part.nc"
    assert not errors(convert(source, target, out, ReadingOptions("BC")))
    assert [path.name for path in out.parent.iterdir()] == ["part.nc"]
    back, diagnostics = read_part_program(out, ReadingOptions(AXIS_WORDS[TARGETS[target]]))
    assert not errors(diagnostics)
    np.testing.assert_allclose(back.position, given.position, rtol=0, atol=0.2 * MICRON)
    np.testing.assert_allclose(back.tool_axis, given.tool_axis, rtol=0, atol=3e-6)


def test_nothing_is_written_when_the_form_cannot_say_the_program(tmp_path):
    source = saved(tmp_path / "part.ngc", write(cone(9), GcodeDialect.VECTOR)[0])
    found = convert(source, "gcode:3axis", tmp_path / "out.nc", ReadingOptions("vector"))
    assert [one.code for one in errors(found)] == ["G501"]
    assert not (tmp_path / "out.nc").exists()


def test_nothing_is_written_when_the_source_has_errors(tmp_path):
    source = saved(tmp_path / "part.ngc", "G0 X0 Y0 Z0\nG1 X1\nM2\n")
    assert [one.code for one in convert(source, "gcode:vector", tmp_path / "out.nc")] == ["G408"]
    assert not (tmp_path / "out.nc").exists()


def test_a_folder_that_cannot_be_made_is_reported(tmp_path):
    source = saved(tmp_path / "part.ngc", "G0 X0 Y0 Z0\nM2\n")
    (tmp_path / "taken").write_text("")
    assert [one.code for one in convert(source, "gcode:vector", tmp_path / "taken" / "out.nc")] == ["F101"]


@pytest.mark.parametrize("name", ["part.ngc", "link.ngc", "folder/../part.ngc"])
def test_a_source_is_not_replaced_by_its_own_conversion(tmp_path, name):
    source = saved(tmp_path / "part.ngc", "G0 X0 Y0 Z0\nM2\n")
    (tmp_path / "folder").mkdir()
    (tmp_path / "link.ngc").symlink_to(source)
    before = source.read_bytes()
    assert [one.code for one in errors(convert(source, "gcode:vector", tmp_path / name))] == ["F120"]
    assert source.read_bytes() == before
    assert (tmp_path / "link.ngc").is_symlink()


@pytest.mark.parametrize("is_link", [False, True])
def test_a_pipe_is_not_replaced(is_link, tmp_path):
    """As little as a device: an administrator's ``--out /dev/null`` would take it from all programs."""
    source, out = saved(tmp_path / "part.ngc", "G0 X0 Y0 Z0\nG1 X1 F100\nM2\n"), tmp_path / "out" / "new.nc"
    out.parent.mkdir()
    os.mkfifo(tmp_path / "pipe" if is_link else out)
    if is_link:
        out.symlink_to(tmp_path / "pipe")
    (fault,) = errors(convert(source, "gcode:vector", out))
    assert fault.code == "F101" and "a device or a pipe" in fault.found
    assert stat.S_ISFIFO(out.stat().st_mode) and [path.name for path in out.parent.iterdir()] == ["new.nc"]


def test_compensation_needs_a_diameter(tmp_path):
    source = saved(tmp_path / "part.ngc", "T3 M6\nG0 X0 Y0 Z0\nG41\nG1 X10 F100\nY10\nG40\nX20\nM2\n")
    assert "G411" in [one.code for one in check_file(source).diagnostics]
    result, found = read_part_program(source, ReadingOptions(tools={3: Tool(3, "", 8.0, 0.0, 0.0, corner_known=False)}))
    assert not errors(found)
    assert result.side_offset.max() == 4.0


CL_DATA = """UNITS/MM
CUTTER/10.0
LOADTL/1,LENGTH,80.0
SPINDL/3000,RPM,CLW
FEDRAT/600,MMPM
MULTAX/ON
RAPID
GOTO/0,0,10,0,0,1
GOTO/0,0,5,0,0.6,0.8
GOTO/3,4,5,0,0.6,0.8
FINI
"""


def test_cl_data_is_checked_and_converted(tmp_path):
    source, out = saved(tmp_path / "part.apt", CL_DATA), tmp_path / "part.ngc"
    checked = check_file(source)
    assert checked.is_clean
    assert (checked.size.blocks, checked.size.length) == (3, 10.0)
    assert not errors(convert(source, "gcode:BC", out))
    back, diagnostics = read_part_program(out, ReadingOptions("BC"))
    assert not errors(diagnostics)
    np.testing.assert_allclose(back.tool_axis[1:], [[0, 0.6, 0.8]] * 2, atol=1e-8)
    np.testing.assert_allclose(back.feed[1:], 10.0)


def test_size_of_a_square_with_an_arc():
    size = size_of(square_with_arc())
    # Down 20, along 30, half a circle of radius 10, back 30, down Y 20, a turn of radius 5 with a rise of 4.
    assert size.length == pytest.approx(20 + 30 + 10 * np.pi + 30 + 20 + np.hypot(10 * np.pi, 4))
    assert (size.blocks, size.arcs) == (7, 2)
    assert size.lowest == pytest.approx((0, -5, 36))
    assert size.highest == pytest.approx((40, 20, 60))


def test_the_box_holds_arcs_of_any_axis():
    rng = np.random.default_rng(6)
    for _ in range(20):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        start = np.cross(axis, rng.normal(size=3))
        across = np.cross(axis, start)
        sweep, rise = rng.uniform(0.1, 6.2), rng.normal() * 0.1
        turned = np.linspace(0, sweep, 2001)[:, None]
        points = np.cos(turned) * start + np.sin(turned) * across + turned / sweep * rise * axis
        given = program(points[[0, -1]], kind=[Kind.RAPID, Kind.ARC], centre=np.zeros((2, 3)), turn=[axis, axis])
        size = size_of(given)
        # The rise moves the extremes by less than its square.
        np.testing.assert_allclose(size.lowest, points.min(axis=0), atol=rise**2 + 1e-5)
        np.testing.assert_allclose(size.highest, points.max(axis=0), atol=rise**2 + 1e-5)


def test_check_tells_line_and_caret_and_fails(tmp_path, capsys):
    good = saved(tmp_path / "good.ngc", "G0 X0 Y0 Z0\nG1 X10 F100\nG2 X20 I5 J0\nM2\n")
    bad = saved(tmp_path / "bad.ngc", "G0 X0 Y0 Z0\nG1 X1..5 F100\n")
    assert main(["check", str(good), str(bad)]) == 1
    reported = capsys.readouterr().out.splitlines()
    assert reported[0] == f"{good}: flavour rs274: nothing in the program speaks for another"
    assert reported[1].startswith(f"{bad}: line 2:")
    assert " G102: " in reported[1]
    assert reported[2:4] == ["    G1 X1..5 F100", "        ^"]
    assert reported[4].split() == [
        "file",
        "blocks",
        "arcs",
        "length",
        "mm",
        "lowest",
        "X",
        "Y",
        "Z",
        "highest",
        "X",
        "Y",
        "Z",
    ]
    assert reported[5].split() == [str(good), "3", "1", "25.708", "0.000", "0.000", "0.000", "20.000", "5.000", "0.000"]
    assert reported[6].split() == [str(bad), "-", "-", "-", "-", "-"]


def test_check_writes_json(tmp_path, capsys):
    file = saved(tmp_path / "bad.ngc", "G0 X0 Y0 Z0\nG1 X1..5 F100\n")
    assert main(["check", "--json", str(file)]) == 1
    (entry,) = json.loads(capsys.readouterr().out)
    assert entry["size"] is None
    (reported,) = entry["diagnostics"]
    assert (reported["code"], reported["severity"], reported["line"], reported["column"]) == ("G102", "error", 2, 5)


def test_check_of_a_clean_file_succeeds(tmp_path, capsys):
    file = saved(tmp_path / "good.ngc", "G0 X0 Y0 Z0\nG1 X3 Y4 F100\nM2\n")
    assert main(["check", "--json", str(file)]) == 0
    (entry,) = json.loads(capsys.readouterr().out)
    assert entry["size"]["length_mm"] == 5.0
    assert entry["diagnostics"] == []


def test_zero_has_no_sign_in_the_size_of_a_program(tmp_path, capsys):
    file = saved(tmp_path / "part.nc", "G21 G90\nG0 X-0.0004 Y0 Z5\nG1 X1 F100\nM2\n")
    assert main(["check", str(file)]) == 0
    assert "-0.000" not in capsys.readouterr().out


@pytest.mark.parametrize(("file", "code", "fault"), [("missing.ngc", 1, "F103"), (__file__, 2, "F122")])
def test_files_that_are_not_read(file, code, fault, capsys):
    assert main(["check", file]) == code
    assert f"error {fault}: " in "".join(capsys.readouterr())


@pytest.mark.parametrize("command", ["reach", "stiffness"])
def test_nothing_is_printed_of_no_study(command, capsys):
    assert main([command, "missing.ngc"]) == 1
    printed = capsys.readouterr()
    assert printed.out == "" and "error F103: " in printed.err


def test_arguments_that_make_no_sense(capsys):
    with pytest.raises(SystemExit) as stopped:
        main(["convert", "--to", "gcode:XY", "--out", "a.nc"])
    assert stopped.value.code == 2
    assert "error" in capsys.readouterr().err


def test_convert_from_the_command_line(tmp_path, capsys):
    source = saved(tmp_path / "part.ngc", write(replace(square_with_arc(), source="x"), GcodeDialect.PLAIN)[0])
    out = tmp_path / "part.nc"
    assert main(["convert", str(source), "--to", "gcode:vector", "--out", str(out)]) == 0
    assert capsys.readouterr().out.strip() == str(out)
    assert Path(out).read_text().endswith("\nM2\n")
    first = out.read_bytes()
    assert main(["convert", str(source), "--to", "gcode:vector", "--out", str(out)]) == 0
    assert out.read_bytes() == first


def test_help_names_every_form(capsys):
    with pytest.raises(SystemExit):
        main(["convert", "--help"])
    reported = capsys.readouterr().out
    assert all(target in reported for target in TARGETS)


def commands_of(parser, names=()):
    """The words of each command with its parser, those of its actions behind it."""
    for action in parser._subparsers._group_actions if parser._subparsers else ():
        for name, below in action.choices.items():
            yield (*names, name), below
            yield from commands_of(below, (*names, name))


def test_the_help_of_each_command_says_what_it_does_and_what_its_arguments_are():
    commands = dict(commands_of(_parser()))
    assert {("cartesian",), ("machine", "check"), ("pmac", "jog")} <= set(commands) and len(commands) > 30
    listed = " ".join(_parser().format_help().split())
    for names, parser in commands.items():
        assert parser.description and parser.description.endswith("."), names
        if len(names) == 1 and names != ("install",):
            assert f"{parser.description[0].lower()}{parser.description[1:-1]}" in listed
        positional = [action for action in parser._get_positional_actions() if not action.choices]
        assert all(action.help for action in positional), names


def test_a_command_is_found_without_the_modules_of_the_others():
    for name in {names[0] for names, _ in commands_of(_parser())} - {"pmac", "play"}:
        alone = {names[0] for names, _ in commands_of(_parser([name]))}
        assert name in alone and "pmac" not in alone


@pytest.mark.parametrize("option", ["--out", "--part", "--subprograms", "--tool-table"])
def test_a_character_that_no_name_of_a_file_has_is_refused(option, tmp_path, capsys):
    """No shell passes it, but a batch list or another program may."""
    for written in ([option, "a\0b"], [f"{option}=a\0b"]):
        with pytest.raises(SystemExit) as refused:
            main(["post", str(tmp_path / "part.ngc"), *written])
        assert refused.value.code == 2
        assert "error U103: an argument is not valid: " in (reported := capsys.readouterr().err)
        assert "a\\x00b': expected no character NUL" in reported
