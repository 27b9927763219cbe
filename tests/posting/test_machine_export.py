# SPDX-License-Identifier: LGPL-2.1-or-later
"""``machine export``: files that appear together, the sheet beside them, and what is refused."""

import hashlib
import re

import numpy as np
import pytest

from pkm_post.cli import main
from pkm_post.machine import find_machine, machine_named, strut_lengths
from pkm_post.posting.machine_export import check_poses

FILES = {
    "turbo-pmac": ["example_6tps-kinematics.pmc", "example_6tps-sign-off.md"],
    "power-pmac": ["example_6tps-kinematics.cfg", "example_6tps-sign-off.md"],
    "linuxcnc": [
        f"example_6tps{ending}"
        for ending in ("-kinematics.hal", "-sign-off.md", "-simulated-drives.hal", "-stream.hal", ".ini", ".tbl")
    ],
}


@pytest.mark.parametrize("target", FILES)
def test_files_and_sheet_appear_together(target, tmp_path, capsys):
    assert main(["machine", "export", "example_6tps", "--to", target, "--out", str(tmp_path / "out")]) == 0
    made = sorted((tmp_path / "out").iterdir())
    assert [path.name for path in made] == FILES[target]
    assert sorted(capsys.readouterr().out.splitlines()) == [str(path) for path in made]
    sheet = (tmp_path / "out" / "example_6tps-sign-off.md").read_text()
    for path in made:
        if not path.match("*.md"):
            assert hashlib.sha256(path.read_bytes()).hexdigest() in sheet
    assert sheet.count("- [ ]") > 12 and machine_named("example_6tps")[0].fingerprint in sheet


def test_sheet_has_the_counts_of_our_kinematics(tmp_path):
    """Home is where the motors count zero; 20 mm along z and the counts of the strut lengths there, rounded."""
    assert main(["machine", "export", "example_6tps", "--to", "turbo-pmac", "--out", str(tmp_path)]) == 0
    rows = re.findall(r"^\|( -?[\d.]+ \|){12} \[ \] \|$", (tmp_path / "example_6tps-sign-off.md").read_text(), re.M)
    assert len(rows) == 13
    text = (tmp_path / "example_6tps-sign-off.md").read_text()
    assert "| 0 | 0 | 300 | 0 | 0 | 0 | 0 | 0 | 0 | 0 | 0 | 0 | [ ] |" in text
    machine = machine_named("example_6tps")[0]
    tip, up = np.array([[0.0, 0.0, 320.0]]), np.array([[0.0, 0.0, 1.0]])
    counts = np.rint((strut_lengths(machine, tip, up, np.zeros(1), np.full(1, 120.0))[0] - 1007.8869) * 10000)
    assert "| 0 | 0 | 320 | 0 | 0 | 0 | " + " | ".join(f"{count:.0f}" for count in counts) in text


def test_linuxcnc_has_no_segments(tmp_path, capsys):
    out = tmp_path / "out"
    arguments = ["machine", "export", "example_6tps", "--to", "linuxcnc", "--out", str(out), "--segment-time", "5"]
    assert main(arguments) == 2
    assert "--segment-time" in capsys.readouterr().err and not out.exists()


def test_positions_out_of_reach_are_not_on_the_sheet():
    machine = machine_named("example_6tps")[0]
    assert len(check_poses(machine, 120.0).axes) == 13
    assert len(check_poses(machine, 700.0).axes) == 0


def test_segment_time_and_tool_length_are_in_the_file(tmp_path):
    options = ["--segment-time", "5", "--tool-length", "87.5"]
    assert main(["machine", "export", "example_6tps", "--to", "turbo-pmac", "--out", str(tmp_path), *options]) == 0
    text = (tmp_path / "example_6tps-kinematics.pmc").read_text()
    assert "\nI5113=5 ;" in text and "\nQ50=87.5 ;" in text


@pytest.mark.parametrize(
    "options",
    [
        ["--segment-time", "0"], ["--segment-time", "256"], ["--segment-time", "2.5"], ["--tool-length", "-1"],
        ["--tool-length", "long"], ["--tool-length", "nan"], ["--to", "siemens"],
    ],
)  # fmt: skip
def test_arguments_that_make_no_sense_end_with_2(options, tmp_path):
    with pytest.raises(SystemExit) as ended:
        main(["machine", "export", "example_6tps", "--to", "turbo-pmac", "--out", str(tmp_path / "out"), *options])
    assert ended.value.code == 2 and not (tmp_path / "out").exists()


DECIMALS_AND_LIMIT = "length_decimals = 6\nspeed_decimals = 4\n"


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ((DECIMALS_AND_LIMIT, "length_decimals = 1\nspeed_decimals = 1\nline_limit = 85\n"), "lines of the kinematics"),
        (("kind = ", "kinds = "), "M105"),
        (("", ""), "F101"),
    ],
)
def test_what_is_refused_leaves_no_file(change, code, tmp_path, capsys):
    file, out = tmp_path / "mine.toml", tmp_path / "out"
    text = find_machine("example_6tps").read_text().replace(*change)
    file.write_text(text.replace("line_limit = 159\n", "") if "line_limit = 85" in text else text)
    if code == "F101":
        out.write_text("a file is in the way")
    assert main(["machine", "export", str(file), "--to", "power-pmac", "--out", str(out)]) == 1
    assert code in capsys.readouterr().err
    assert out.is_file() or not out.exists()


def test_a_machine_that_cannot_reach_its_home_is_exported_with_a_warning(tmp_path, capsys):
    file = tmp_path / "mine.toml"
    file.write_text(find_machine("example_6tps").read_text().replace("[0.0, 0.0, 300.0]", "[0.0, 0.0, 700.0]"))
    assert main(["machine", "export", str(file), "--to", "turbo-pmac", "--out", str(tmp_path / "out")]) == 0
    assert "M108" in capsys.readouterr().err
    assert "None: the machine reaches no position" in (tmp_path / "out" / "mine-sign-off.md").read_text()
