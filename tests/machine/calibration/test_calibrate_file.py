# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a file of measurements to a machine file: the published hexapod, whose real geometry is known."""

import dataclasses

import numpy as np
import pytest
from machines import direction

from pkm_post.cli import main
from pkm_post.machine.calibration.calibrate_file import COLUMNS, calibrate_file
from pkm_post.machine.description.presets import find_machine
from pkm_post.machine.description.reader import read_machine
from pkm_post.machine.kinematics.inverse import strut_lengths

MICRON = 1e-3


def preset(name):
    return read_machine(find_machine(name))[0]


def parameters(machine):
    return np.hstack([machine.base_joints, machine.platform_joints, machine.length_offset[:, None]])


def measurements(tmp_path, machine, count=30, tilt_deg=20.0):
    rng = np.random.default_rng(1)
    tip = rng.uniform([-150, -150, 750], [150, 150, 950], (count, 3))
    axis = direction(rng.uniform(0, tilt_deg, count), rng.uniform(0, 360, count)).T
    spin = rng.uniform(-1, 1, count) * tilt_deg
    lengths = strut_lengths(machine, tip, axis, np.radians(spin), np.zeros(count))
    path = tmp_path / "poses.csv"
    table = np.column_stack([tip, axis, spin, np.zeros(count), lengths])
    np.savetxt(path, table, delimiter=",", header=",".join(COLUMNS), comments="", fmt="%.12f")
    return path


def test_the_new_file_is_the_real_machine(tmp_path):
    real = preset("nategh_agheli_calibrated")
    out = tmp_path / "new" / "mine.toml"
    report, reported = calibrate_file("nategh_agheli_nominal", measurements(tmp_path, real), out)
    assert reported == ()
    assert "rank 42 of 42" in report
    machine, faults = read_machine(out)
    assert faults == ()
    assert np.abs(parameters(machine) - parameters(real)).max() < MICRON
    text = out.read_text(encoding="utf-8")
    assert text.startswith("# Calibrated with poses.csv: 30 poses, rank 42 of 42, lengths off by ")
    assert "# Assumed: the radius of the platform joints, and a limit away from singular poses." in text


def test_the_measurements_and_the_machine_file_are_not_replaced(tmp_path):
    path = measurements(tmp_path, preset("nategh_agheli_calibrated"))
    nominal = tmp_path / "nominal.toml"
    nominal.write_bytes(find_machine("nategh_agheli_nominal").read_bytes())
    for out in (path, nominal):
        before = out.read_bytes()
        report, reported = calibrate_file(str(nominal), path, out)
        assert report is None and [each.code for each in reported] == ["F120"]
        assert out.read_bytes() == before


@pytest.mark.parametrize("folder", ["", "new"])
def test_the_tool_table_beside_the_machine_file_is_still_found(tmp_path, folder):
    nominal, table = tmp_path / "nominal.toml", tmp_path / "tools [1].tbl"
    entry = '\n[part_programs]\ntool_table = "tools [1].tbl,mm"  # of the shop\n'
    nominal.write_text(find_machine("nategh_agheli_nominal").read_text(encoding="utf-8") + entry, encoding="utf-8")
    out = tmp_path / folder / "mine.toml"
    _, reported = calibrate_file(str(nominal), measurements(tmp_path, preset("nategh_agheli_calibrated")), out)
    assert reported == ()
    assert read_machine(out)[0].tool_table == f"{table},mm"
    assert ("of the shop" in out.read_text(encoding="utf-8")) and (entry in out.read_text(encoding="utf-8")) != bool(
        folder
    )


def test_an_inch_file_stays_an_inch_file(tmp_path):
    nominal = preset("linuxcnc_genhexkins")
    rng = np.random.default_rng(2)
    real = dataclasses.replace(nominal, base_joints=nominal.base_joints + rng.normal(0, 0.5, (6, 3)))
    path = measurements(tmp_path, real)
    out = tmp_path / "mine.toml"
    _, reported = calibrate_file("linuxcnc_genhexkins", path, out)
    assert reported == ()
    assert 'length = "inch"' in out.read_text(encoding="utf-8")
    assert np.abs(parameters(read_machine(out)[0]) - parameters(real)).max() < MICRON


def test_poses_that_tell_too_little_are_a_warning(tmp_path):
    path = measurements(tmp_path, preset("nategh_agheli_calibrated"), tilt_deg=0.0)
    report, (reported,) = calibrate_file("nategh_agheli_nominal", path, tmp_path / "mine.toml")
    assert (reported.code, reported.found) == ("M205", "rank 24 of 42")
    assert report.count("not determined: strut") == 18
    assert (tmp_path / "mine.toml").exists()


def test_nothing_is_written_when_no_machine_fits(tmp_path):
    path = measurements(tmp_path, preset("nategh_agheli_calibrated"))
    rows = path.read_text().splitlines()
    rng = np.random.default_rng(3)
    wrong = [",".join([*row.split(",")[:8], *map(str, rng.uniform(1, 5e5, 6))]) for row in rows[1:]]
    path.write_text("\n".join([rows[0], *wrong]))
    report, reported = calibrate_file("nategh_agheli_nominal", path, tmp_path / "mine.toml")
    assert report is None
    assert {item.severity.value for item in reported} == {"error"}
    assert not (tmp_path / "mine.toml").exists()


def test_faults_of_both_files_are_reported(tmp_path):
    report, reported = calibrate_file("vamt1y", tmp_path / "none.csv", tmp_path / "mine.toml")
    assert report is None
    assert {item.code for item in reported} == {"M107", "M201"}


def test_entries_that_cannot_be_replaced_are_reported(tmp_path):
    path = measurements(tmp_path, preset("nategh_agheli_calibrated"))
    text = find_machine("nategh_agheli_nominal").read_text(encoding="utf-8")
    start, end = text.index("[base]"), text.index("# On a circle of 125")
    rows = text[start:end].split("joints = ", 1)[1].replace("\n", " ")
    machine = tmp_path / "inline.toml"
    machine.write_text(f"base = {{ joints = {rows} }}\n{text[:start]}{text[end:]}", encoding="utf-8")
    assert read_machine(machine)[1] == ()
    report, (reported,) = calibrate_file(str(machine), path, tmp_path / "mine.toml")
    assert report is None
    assert reported.code == "M204"


def test_a_folder_that_cannot_be_written_is_reported(tmp_path):
    path = measurements(tmp_path, preset("nategh_agheli_calibrated"))
    report, (reported,) = calibrate_file("nategh_agheli_nominal", path, path / "mine.toml")
    assert report is None
    assert reported.code == "F101"


def test_the_command_reports_and_names_the_file(tmp_path, capsys):
    path, out = measurements(tmp_path, preset("nategh_agheli_calibrated")), tmp_path / "mine.toml"
    assert main(["machine", "calibrate", "nategh_agheli_nominal", str(path), "--out", str(out)]) == 0
    reported = capsys.readouterr()
    assert reported.err == ""
    assert reported.out.splitlines()[-1] == str(out)
    assert "strut 6" in reported.out
    assert main(["machine", "check", str(out)]) == 0
    assert main(["machine", "calibrate", "nategh_agheli_nominal", "none.csv", "--out", str(out)]) == 1
    with pytest.raises(SystemExit) as stopped:
        main(["machine", "calibrate", "nategh_agheli_nominal"])
    assert stopped.value.code == 2
