# SPDX-License-Identifier: LGPL-2.1-or-later
"""The form in tip and axis: struts and certificate are those of the program it was made from."""

import dataclasses
import itertools
import re
import sys
from pathlib import Path

import numpy as np
import programs
import pytest

from pkm_post.cli import main
from pkm_post.control.simulator import Controller
from pkm_post.machine import machine_named, strut_lengths
from pkm_post.model import Box, Event, EventKind, Refused
from pkm_post.options import Options
from pkm_post.posting import Allowance, cartesian_program, post, verify
from pkm_post.posting.verify import read_motion
from pkm_post.writing import manifest

sys.path.append(str(Path(__file__).parents[1] / "writing" / "kinematics"))

import exported_machines as made  # noqa: E402
from kinematic_language import DOUBLE, TURBO  # noqa: E402

ROUNDING = 5e-7 * (np.sqrt(3) + np.sqrt(3) * np.radians(283.0))
"""mm: half a digit of X Y Z, and of A B C in degrees at the platform joints, 283 mm from the tip; speeds have two
decimals less."""
JOB = dataclasses.replace(programs.cone(30, turns=0.4), events=(Event(12, EventKind.STOP, 0.0),))
ALLOWANCE = Allowance(2.0, 1.5)
MOVE = re.compile(r"^" + " ".join(rf"{letter}(-?[\d.]+):(-?[\d.]+)" for letter in "XYZABC") + "$", re.M)


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    """A job that tilts the tool and stops in between, its folder, and its form in tip and axis."""
    machine, folder = machine_named("example_6tps")[0], tmp_path_factory.mktemp("posted")
    post(JOB, machine, folder / "job.pmc", Options())
    return machine, folder, cartesian_program(folder / "job.pmc", folder / "job.pkmt", machine, folder / "tip.pmc")


def test_its_struts_are_those_of_the_program(posted):
    _, _, form = posted
    assert 0.0 < form.off < ROUNDING
    assert form.certificate.holds and len(form.files) == 1


@pytest.mark.parametrize("name", ["job.pmc", "job.pkmt"])
def test_it_does_not_replace_the_files_it_is_made_from(posted, name):
    machine, folder, _ = posted
    before = (folder / name).read_bytes()
    with pytest.raises(Refused, match="F120"):
        cartesian_program(folder / "job.pmc", folder / "job.pkmt", machine, folder / name)
    assert (folder / name).read_bytes() == before


@pytest.mark.parametrize("bits", [DOUBLE, TURBO])
def test_the_exported_inverse_program_makes_the_struts_of_it(posted, bits):
    """Words of the text, through the kinematic program of ``machine export``, against the program of strut lengths."""
    machine, folder, form = posted
    words = np.array(MOVE.findall(form.files[0].read_text()), dtype=float)
    axes, rates = words[:, 0::2], words[:, 1::2]
    given = dict(zip(("Q7", "Q8", "Q9", "Q1", "Q2", "Q3"), axes.T, strict=True))
    given |= dict(zip(("Q17", "Q18", "Q19", "Q11", "Q12", "Q13"), rates.T, strict=True))
    run = made.controller_of(machine, "turbo", bits).run("inverse", given | {"Q10": 1.0})
    scale, zero = machine.controller["counts_per_mm"], np.array(machine.controller["zero_length"])
    struts = read_motion(folder / "job.pmc", machine)
    found = np.stack([run[f"P{motor}"] for motor in range(1, 7)], axis=1) / scale + zero
    speeds = np.stack([run[f"P10{motor}"] for motor in range(1, 7)], axis=1) / scale
    assert len(found) == len(struts) - 1
    np.testing.assert_allclose(found, struts.length[1:], rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(speeds, struts.speed[1:], rtol=0, atol=100 * ROUNDING)
    assert np.ptp(axes, axis=0).min() > 1.0


def test_a_posting_writes_it_beside_the_program(posted, tmp_path):
    """The same text as the command makes of the same program, and the manifest has it."""
    machine, folder, form = posted
    lines = []
    post(JOB, machine, tmp_path / "job.pmc", Options(also=("cartesian",)), lines.append)
    assert (tmp_path / "job.pmc").read_bytes() == (folder / "job.pmc").read_bytes()
    assert (tmp_path / "job-tip.pmc").read_bytes() == form.files[0].read_bytes()
    assert manifest.check(tmp_path / "job.pmc")[0].fingerprint_of("job-tip.pmc")
    assert lines[-1].startswith("also cartesian") and "struts at most" in lines[-1]


def test_struts_may_have_the_letters_of_the_form(tmp_path):
    machine = machine_named("example_6tps")[0]
    other = dataclasses.replace(machine, controller={**machine.controller, "letters": ["X", "Y", "Z", "U", "V", "W"]})
    assert post(JOB, other, tmp_path / "job.pmc", Options(also=("cartesian",)))


def test_heading_says_what_it_runs_with(posted):
    text = posted[2].files[0].read_text()
    assert "; runs with I5150=1, Q50=120 and Q51 to Q54 zero, never with I5150=0" in text
    assert "FRAX(X,Y,Z,A,B,C)" in text and "strut lengths" not in text


SWITCHES = "I5150=1 Q50=120 Q51=0 Q52=0 Q53=0 Q54=0"


def on_the_simulator(text, switches):
    """Whether the program begins to move, with these values at the machine, and what it says."""
    controller, said = Controller(), []
    controller.listeners.append(said.append)
    controller.load([*(f"#{motor}->100{letter}" for motor, letter in enumerate("XYZABC", 1)), *SWITCHES.split()])
    controller.load([f"#{motor}J/ #{motor}HMZ" for motor in range(1, 7)])
    controller.load(switches.split())
    controller.load([line.split(";")[0] for line in text.splitlines()])
    controller.load(["&1B10R"])
    controller.advance(100)
    return controller.systems[0].running, said


@pytest.mark.parametrize(
    ("switches", "said"),
    [
        ("", None),
        ("I5150=0", "KINEMATICS ARE OFF: I5150"),
        ("Q50=120.001", "ANOTHER TOOL LENGTH: Q50"),
        ("Q50=119.999", "ANOTHER TOOL LENGTH: Q50"),
        ("Q52=-0.001", "ANOTHER WORK FRAME: Q51 TO Q53"),
        ("Q54=0.001", "ANOTHER WORK FRAME: Q54"),
    ],
)
def test_it_ends_before_its_first_move_where_the_controller_is_set_up_otherwise(posted, switches, said):
    running, heard = on_the_simulator(posted[2].files[0].read_text(), switches)
    assert (running, heard) == ((True, []) if said is None else (False, [said]))


@pytest.fixture(scope="module")
def allowed(posted, tmp_path_factory):
    """The same form for tools that are up to 2 mm off, and a work frame that is up to 1.5 mm off."""
    machine, folder, _ = posted
    out = tmp_path_factory.mktemp("allowed") / "tip.pmc"
    return cartesian_program(folder / "job.pmc", folder / "job.pkmt", machine, out, ALLOWANCE)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("switches", "runs"),
    [("Q50=121.9 Q51=1.4 Q52=-1.4 Q53=1.4", True), ("Q50=118.1", True), ("Q50=122.1", False), ("Q53=1.6", False)],
)
def test_what_is_allowed_at_the_machine_runs(allowed, switches, runs):
    text = allowed.files[0].read_text()
    assert "Q50=120 up to 2 more or less, Q51 to Q53 up to 1.5 from zero, Q54 zero" in text
    assert on_the_simulator(text, switches)[0] is runs


def test_the_corners_are_what_the_exported_kinematics_do(posted):
    """Counts of the inverse program with other variables, against the strut lengths of the machine of the corner."""
    machine = posted[0]
    axes = np.random.default_rng(2).uniform(-1, 1, (50, 6)) * [50, 50, 40, 8, 8, 5]
    axes[:, :3] += machine.home_tip
    corners = dict(ALLOWANCE.corners(machine))
    assert len(corners) == 16
    place = made.tool_poses(axes)
    for x, y, z, longer in itertools.product((-1.5, 1.5), (-1.5, 1.5), (-1.5, 1.5), (-2.0, 2.0)):
        values = {"Q50": 120.0 + longer, "Q51": x, "Q52": y, "Q53": z, "Q10": 0.0}
        given = dict(zip(("Q7", "Q8", "Q9", "Q1", "Q2", "Q3"), axes.T, strict=True))
        run = made.controller_of(machine, "turbo").run("inverse", given | values)
        corner = corners[f"work frame at {x:+g}, {y:+g}, {z:+g}, tool {longer:+g} mm"]
        found = np.stack([run[f"P{motor}"] for motor in range(1, 7)], axis=1) / machine.controller["counts_per_mm"]
        lengths = strut_lengths(corner, *place) - np.array(machine.controller["zero_length"])
        np.testing.assert_allclose(found, lengths, rtol=0, atol=1e-9)


@pytest.mark.slow
def test_a_strut_that_is_shortest_between_the_corners_is_within_its_stroke(posted):
    """Random machines and poses; the lengths at points of the box, against a stroke that the corners just keep."""
    machine, chance, shorter = posted[0], np.random.default_rng(3), 0
    box = np.array(list(itertools.product((-1.0, -0.5, 0.0, 0.5, 1.0), repeat=3)))
    allowance = Allowance(2.0, 20.0)
    for _ in range(60):
        base = machine.base_joints + chance.normal(0, 80, (6, 3))
        tip, axis = machine.home_tip + chance.uniform(-1, 1, (1, 3)) * [150, 150, 60], np.array([[0.0, 0.0, 1.0]])
        place = tip, axis, np.zeros(1), np.array([120.0])
        some = dataclasses.replace(machine, base_joints=base)
        corners = [corner for _, corner in allowance.corners(some)]
        kept = np.min([strut_lengths(corner, *place)[0] for corner in corners], axis=0)
        margin = corners[0].strut_stroke[0] - some.strut_stroke[0]
        changed = [
            dataclasses.replace(some, base_joints=base - 20.0 * at, spindle_nose=some.spindle_nose + tool)
            for at, tool in itertools.product(box, (-2.0, 0.0, 2.0))
        ]
        between = np.min([strut_lengths(each, *place)[0] for each in changed], axis=0)
        assert (between >= kept - margin * some.strut_stroke[0] / between.min()).all()
        shorter += (between < kept - 1e-3).any()
    assert shorter > 3


def test_a_range_beyond_the_gauge_length_is_verified_as_it_is_written(tmp_path):
    files = tmp_path / "job.pmc", tmp_path / "job.pkmt", machine_named("example_6tps")[0], tmp_path / "tip.pmc"
    tools = {1: dataclasses.replace(programs.BALL, length=20.0)}
    high = programs.program([[0, 0, 160], [0, 0, 150]], tools=tools)
    post(high, files[2], files[0], Options(work_offset=programs.ON_PALLET))
    cartesian_program(*files, Allowance(30.0, 0.0))
    assert "Q50<-10.0000" in files[3].read_text()
    assert verify(files[3], files[1], files[2]).certificate.holds


@pytest.mark.parametrize("offset", [-300.0, 500.0])
def test_the_stroke_of_the_corners_does_not_depend_on_where_the_controller_counts_from(posted, offset):
    machine = posted[0]
    counted = dataclasses.replace(
        machine,
        length_offset=machine.length_offset + offset,
        strut_stroke=tuple(length - offset for length in machine.strut_stroke),
    )
    strokes = [
        [corner.strut_stroke[0] - some.strut_stroke[0] for _, corner in ALLOWANCE.corners(some)]
        for some in (machine, counted)
    ]
    assert strokes[0] == pytest.approx(strokes[1], rel=1e-9)


@pytest.mark.slow
def test_a_stroke_that_the_corners_keep_and_a_point_between_them_may_not_is_refused(posted, tmp_path):
    machine, folder, form = posted
    allowance = Allowance(0.0, 20.0)
    axes = np.array(MOVE.findall(form.files[0].read_text()), dtype=float)[:, 0::2]
    corners = [corner for _, corner in allowance.corners(machine)]
    kept = min(float(strut_lengths(corner, *made.tool_poses(axes)).min()) for corner in corners)
    margin = 3 * 20.0**2 / (2 * machine.strut_stroke[0])
    for below, holds in ((1.5 * margin, True), (0.5 * margin, False)):
        other = dataclasses.replace(machine, strut_stroke=(kept - below, machine.strut_stroke[1]))
        files = folder / "job.pmc", folder / "job.pkmt", other, tmp_path / f"{holds}.pmc", allowance
        if holds:
            assert cartesian_program(*files).files
        else:
            with pytest.raises(Refused, match="C115"):
                cartesian_program(*files)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("lowest", "highest", "allowed", "refused"),
    [([-50, -50, 0], [50, 50, 265], 2.9, 3.1), ([36, -0.5, 0], [37, 0.5, 290], 8.9, 10.0)],
    ids=["below the holder", "a pin beside it, which it meets between two corners only"],
)
def test_fixtures_stay_with_the_machine_when_the_work_frame_moves(tmp_path, lowest, highest, allowed, refused):
    """The holder, of 25 mm radius, goes down to 270 mm, with a clearance of 2 mm."""
    vice = Box("vice", np.array(lowest, float), np.array(highest, float))
    machine = dataclasses.replace(machine_named("example_6tps")[0], fixtures=(vice,))
    files = tmp_path / "job.pmc", tmp_path / "job.pkmt", machine, tmp_path / "tip.pmc"
    post(programs.program([[0, 0, 60], [0, 0, 50]]), machine, files[0], Options(work_offset=programs.ON_PALLET))
    assert cartesian_program(*files, Allowance(0.0, allowed)).files
    with pytest.raises(Refused, match=r"(?s)C115.*K116"):
        cartesian_program(*files, Allowance(0.0, refused))


def test_an_allowance_beyond_the_machine_is_refused(posted, tmp_path):
    machine, folder, _ = posted
    with pytest.raises(Refused, match=r"C115.*tip.pmc|tip.pmc.*C115") as refused:
        cartesian_program(folder / "job.pmc", folder / "job.pkmt", machine, tmp_path / "tip.pmc", Allowance(0.0, 90.0))
    assert "work frame at -90, -90, -90, tool +0 mm" in str(refused.value) and not list(tmp_path.iterdir())


def test_a_changed_program_is_refused(posted, tmp_path):
    machine, folder, _ = posted
    changed = folder / "job.pmc"
    text = changed.read_text()
    try:
        changed.write_text(re.sub(r"A(\d+)", lambda found: f"A{int(found[1]) + 3}", text, count=20))
        with pytest.raises(Refused):
            cartesian_program(changed, folder / "job.pkmt", machine, tmp_path / "tip.pmc")
    finally:
        changed.write_text(text)
    assert not list(tmp_path.iterdir())


def test_tools_of_several_lengths_are_refused(tmp_path):
    machine = machine_named("example_6tps")[0]
    job = programs.cone(24, turns=0.2)
    length = next(iter(job.tools.values()))
    two = {1: length, 2: dataclasses.replace(length, number=2, length=length.length + 10.0)}
    events = (Event(0, EventKind.TOOL_CHANGE, 1.0), Event(12, EventKind.TOOL_CHANGE, 2.0))
    post(dataclasses.replace(job, tools=two, events=events), machine, tmp_path / "job.pmc", Options())
    with pytest.raises(Refused, match="C111"):
        cartesian_program(tmp_path / "job.pmc", tmp_path / "job.pkmt", machine, tmp_path / "out" / "tip.pmc")
    assert not (tmp_path / "out").exists()


def test_command_prints_the_certificate_and_the_file(posted, tmp_path, capsys):
    _, folder, _ = posted
    out = tmp_path / "tip.pmc"
    arguments = [str(folder / "job.pmc"), "--against", str(folder / "job.pkmt"), "--machine", "example_6tps"]
    assert main(["cartesian", *arguments, "--out", str(out)]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert printed[-1] == str(out) and any(line.startswith("deviation of the tool tip: ") for line in printed)
    shortest = [line for line in printed if line.startswith("shortest ")]
    assert len(shortest) == 2 and all(", at least " in line and " of " not in line for line in shortest)
