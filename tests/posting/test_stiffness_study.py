# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stiffness along a job and over the table, and the command that says it."""

import json

import numpy as np
import pytest

from pkm_post.cli import main
from pkm_post.machine import (
    StiffnessMap,
    find_machine,
    machine_named,
    pose_path_of,
    stiffness_along,
    stiffness_map,
    table_poses,
)
from pkm_post.posting import prepared_file, stiffness_study

PROGRAM = "G21 G90\nT1 M6\nS8000 M3\nG0 X0 Y0 Z30\nG1 X40 Y0 Z10 F600\nG1 X40 Y30\nG0 Z30\nM5\nM30\n"
GIVEN = ["--tool-length", "1=120", "--work-offset=0,0,200"]


@pytest.fixture
def part(tmp_path):
    path = tmp_path / "part.ngc"
    path.write_text(PROGRAM)
    return path


@pytest.fixture
def study(part):
    prepared = prepared_file(part, arguments=" ".join(GIVEN))
    found, faults = stiffness_study(prepared.placed()[0], prepared.sound[1], step=100.0)
    assert faults == ()
    return found


def test_the_softest_place_is_the_least_of_all_directions_along_the_job(study):
    (softest,) = study.softest()
    machine = prepared_machine()
    way = pose_path_of(study.trajectory)[0].rows(slice(None))
    rng = np.random.default_rng(4)
    some = rng.normal(size=(len(way.tip), 3))
    some /= np.linalg.norm(some, axis=1)[:, None]
    assert (stiffness_along(machine, way, some) >= softest.stiffness * (1 - 1e-9)).all()
    there = tuple(column[[softest.row]] for column in way)
    assert stiffness_along(machine, there, softest.direction[None])[0] == pytest.approx(softest.stiffness, rel=1e-9)
    # Where the tip is lowest and farthest out the struts lean most: the end of the last cut.
    assert softest.line == 6
    assert f"line 6: {softest.stiffness / 1000:.1f} N/um along" in study.text()


def prepared_machine():
    return machine_named("example_6tps")[0]


def test_the_table_is_as_symmetric_as_the_machine(study):
    table = study.table
    assert table.tip[:, 2].min() == table.tip[:, 2].max() == pytest.approx(210.0)
    mirrored = np.lexsort((-table.tip[:, 1], table.tip[:, 0]))  # the example is its own image in the xz plane
    straight = np.lexsort((table.tip[:, 1], table.tip[:, 0]))
    np.testing.assert_allclose(table.least[mirrored], table.least[straight], rtol=1e-9)
    middle = int(np.argmin(np.abs(table.tip[:, :2]).sum(axis=1)))
    assert table.reached[middle] and not table.reached.all()


def test_places_out_of_reach_have_no_number():
    found = stiffness_map(prepared_machine(), table_poses(prepared_machine(), 200.0, 120.0, 300.0))
    rows = found.as_csv().splitlines()[1:]
    assert [row.endswith(",,,,,,") for row in rows] == np.isnan(found.least).tolist()
    assert isinstance(found, StiffnessMap) and 0 < found.reached.sum() < len(rows)


def test_a_step_that_is_no_length_is_the_callers_fault():
    with pytest.raises(ValueError, match="step: expected a length above 0"):
        table_poses(prepared_machine(), 200.0, 120.0, 0.0)


def test_the_command_says_it_and_writes_the_maps(part, tmp_path, capsys):
    assert main(["stiffness", str(part), *GIVEN, "--step", "100", "--out", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "stiffness of the tool tip in its softest direction" in said and "N/um, reached at" in said
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert names == ["part-stiffness-table.csv", "part-stiffness-table.png", "part-stiffness.csv"]


def test_the_command_says_it_in_json(part, study, capsys):
    assert main(["stiffness", str(part), *GIVEN, "--step", "100", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads(json.dumps([study.as_dict()]))


def test_a_machine_file_without_stiffness_is_refused(part, tmp_path, capsys):
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    mine = tmp_path / "mine.toml"
    mine.write_text("\n".join(line for line in text.splitlines() if not line.startswith("stiffness")))
    assert main(["stiffness", str(part), *GIVEN, "--machine", str(mine)]) == 1
    assert "K158" in capsys.readouterr().err


def test_a_refused_job_of_a_document_hides_no_other(part, study, monkeypatch, capsys):
    good = prepared_file(part, arguments=" ".join(GIVEN))
    refused = prepared_file(part, arguments="--tool-length 1=120 --work-offset G59")
    monkeypatch.setattr("pkm_post.cli.reach.programs_of", lambda *_: iter([good, refused, good]))
    assert main(["stiffness", str(part), "--step", "100", "--json"]) == 1
    said = capsys.readouterr()
    assert json.loads(said.out) == json.loads(json.dumps([study.as_dict()] * 2))
    assert "K108" in said.err
