# SPDX-License-Identifier: LGPL-2.1-or-later
"""The kinematic programs, run as the manuals say, against the kinematics of PKM Post."""

import re
from dataclasses import replace

import exported_machines as made
import numpy as np
import pytest
from kinematic_language import DOUBLE, TURBO, Controller

from pkm_post.machine import reach_margins, strut_lengths
from pkm_post.writing.kinematics.controller_file import MOST_STEPS

POSES = 100_000
FEWER = 10_000
"""Where each operation is rounded, which takes several times as long."""
PRINTED = 0.5e-6
"""mm: half of the last digit of a strut length in a motion program."""
ROUNDING = 2e-12
"""mm: some roundings of a double of the size of a strut."""
OFFSET = {"Q51": 11.0, "Q52": -7.0, "Q53": 33.0, "Q54": 40.0}
HOMED = {
    "turbo": {f"M{motor}45": 1.0 for motor in range(1, 7)} | {"M5182": 0.0},
    "power": {"Coord[1].HomeComplete": 1.0, "Ldata.Status": 64.0, "Coord[1].ErrorStatus": 0.0},
}
NO_SPEEDS = {"turbo": {"Q10": 0.0}, "power": {"D0": 0.0}}
FAILED = {"turbo": "M5182", "power": "Coord[1].ErrorStatus"}
MACHINES = {"example": made.example, "calibrated": made.calibrated, "screw": made.screwed, "published": made.published}


@pytest.fixture(scope="module", params=MACHINES)
def machine(request):
    return MACHINES[request.param]()


@pytest.fixture(scope="module")
def axes(machine):
    """Axis positions in the work frame of OFFSET, (N, 6)."""
    return made.about_home(machine, POSES, np.random.default_rng(11), OFFSET)


def given(kind, axes):
    return {made.AXES[kind][axis]: axes[:, place] for place, axis in enumerate("xyzabc")}


def column(values, names, count):
    return np.stack([np.broadcast_to(values[name], count) for name in names], axis=1)


def counts_of(machine, axes):
    """Counts of PKM Post's own lengths."""
    zero, scale = machine.controller["zero_length"], machine.controller["counts_per_mm"]
    return scale * (strut_lengths(machine, *made.tool_poses(axes, OFFSET)) - zero)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "bits", "tolerance"), [("turbo", DOUBLE, ROUNDING), ("turbo", TURBO, PRINTED), ("power", DOUBLE, ROUNDING)]
)
def test_inverse_program_gives_the_counts_of_our_kinematics(machine, axes, kind, bits, tolerance):
    count = POSES if bits == DOUBLE else FEWER
    axes = axes[:count]
    run = made.controller_of(machine, kind, bits).run("inverse", given(kind, axes) | OFFSET | NO_SPEEDS[kind])
    found = column(run, [f"{made.MOTORS[kind]}{motor}" for motor in range(1, 7)], count)
    apart = (found - counts_of(machine, axes)) / machine.controller["counts_per_mm"]
    assert np.abs(apart).max() < tolerance
    assert np.ptp(found, axis=0).min() > 1e5


@pytest.mark.parametrize("kind", ["turbo", "power"])
def test_inverse_program_gives_speeds_in_pvt_mode(machine, axes, kind):
    """Against central differences of our own lengths, 1e-3 s to either side."""
    few, step = axes[:2000], 1e-3
    rates = np.random.default_rng(3).uniform(-1, 1, few.shape) * [200, 200, 200, 20, 20, 20]
    names = {"turbo": "Q17 Q18 Q19 Q11 Q12 Q13", "power": "C38 C39 C40 C32 C33 C34"}[kind].split()
    flag = {"turbo": {"Q10": 1.0}, "power": {"D0": 1.0}}[kind]
    rate_of = dict(zip(names, rates.T, strict=True))
    run = made.controller_of(machine, kind).run("inverse", given(kind, few) | rate_of | OFFSET | flag)
    found = column(run, [{"turbo": f"P10{n}", "power": f"R{n}"}[kind] for n in range(1, 7)], len(few))
    ahead, behind = counts_of(machine, few + step * rates), counts_of(machine, few - step * rates)
    scale = abs(machine.controller["counts_per_mm"])
    np.testing.assert_allclose(found / scale, (ahead - behind) / (2 * step) / scale, rtol=0, atol=1e-4)
    assert np.abs(found / scale).max() > 100.0


def forward(machine, kind, counts, bits=DOUBLE, **values):
    motors = {f"{made.MOTORS[kind]}{motor}": counts[:, motor - 1] for motor in range(1, 7)}
    run = made.controller_of(machine, kind, bits).run("forward", motors | OFFSET | HOMED[kind] | values)
    outcome, steps = (np.broadcast_to(run[name], len(counts)) for name in ("Q300", "Q301"))
    return column(run, made.AXES[kind].values(), len(counts)), outcome, steps, run


def reached(machine, axes):
    """Which positions are within reach; home comes first, on the side of singular poses where the machine is."""
    home = made.in_work_frame(np.append(machine.home_tip, np.zeros(3))[None], OFFSET)
    margins = reach_margins(machine, *made.tool_poses(np.concatenate([home, axes]), OFFSET))
    least = [margins.shortest.min(1), margins.longest.min(1), margins.base.min(1), margins.platform.min(1)]
    return np.min([*least, margins.singular], axis=0)[1:] > 0.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "bits", "tolerance"), [("turbo", DOUBLE, 1e-9), ("turbo", TURBO, 2e-6), ("power", DOUBLE, 1e-9)]
)
def test_forward_program_finds_every_pose_of_a_grid_within_reach(machine, kind, bits, tolerance):
    """From its start, the home position with the platform upright, over all that the machine reaches."""
    grid = made.grid(machine, OFFSET)
    there = grid[reached(machine, grid)]
    assert len(there) > 600
    found, outcome, steps, run = forward(machine, kind, counts_of(machine, there), bits)
    assert not outcome.any() and not np.any(run[FAILED[kind]])
    assert np.abs(found - there).max() < tolerance
    assert steps.max() <= MOST_STEPS - 1


@pytest.mark.slow
def test_forward_program_finds_random_poses_within_reach(machine, axes):
    there = axes[reached(machine, axes)]
    assert len(there) > 0.9 * POSES
    found, outcome, steps, _ = forward(machine, "turbo", counts_of(machine, there))
    assert not outcome.any() and np.abs(found - there).max() < 1e-9
    assert steps.max() <= MOST_STEPS - 2


@pytest.mark.slow
def test_beyond_reach_a_pose_that_is_found_has_the_counts(machine):
    """There another pose may have the same strut lengths; what has others is never found."""
    grid = made.grid(machine, OFFSET)
    beyond = grid[~reached(machine, grid)]
    counts = counts_of(machine, beyond)
    found, outcome, _, _ = forward(machine, "turbo", counts)
    is_found = outcome == 0
    off = (counts_of(machine, found[is_found]) - counts[is_found]) / machine.controller["counts_per_mm"]
    assert np.abs(off).max() < 1e-6
    others = np.abs(found[is_found] - beyond[is_found]).max(axis=1) > 1e-6
    assert np.count_nonzero(~is_found) <= 25 and np.count_nonzero(others) <= 5


@pytest.mark.parametrize("kind", ["turbo", "power"])
def test_counts_of_no_pose_are_reported(kind):
    """Three struts of 900 mm and three of 100 mm fit no pose; the next row does."""
    machine = made.example()
    fit = counts_of(machine, made.grid(machine, OFFSET)[:1])
    lengths = np.array([[900.0, 100.0] * 3])
    counts = np.concatenate([machine.controller["counts_per_mm"] * (lengths - machine.controller["zero_length"]), fit])
    _, outcome, _, run = forward(machine, kind, counts)
    assert outcome.tolist() == [1.0, 0.0]
    assert np.broadcast_to(run[FAILED[kind]], 2).tolist() == [{"turbo": 1.0, "power": 255.0}[kind], 0.0]


def test_a_query_of_the_power_pmac_gets_no_number_for_no_pose():
    machine = made.example()
    counts = machine.controller["counts_per_mm"] * (np.array([[900.0, 100.0] * 3]) - machine.controller["zero_length"])
    found, _, _, run = forward(machine, "power", counts, **{"Ldata.Status": 0.0})
    assert np.isnan(found).all() and run["Coord[1].ErrorStatus"] == 0.0


@pytest.mark.parametrize(("kind", "flag"), [("turbo", "M345"), ("power", "Coord[1].HomeComplete")])
def test_motors_that_are_not_homed_are_an_error(kind, flag):
    machine = made.example()
    counts = counts_of(machine, made.grid(machine, OFFSET)[:1])
    _, outcome, _, run = forward(machine, kind, counts, **{flag: 0.0})
    assert outcome.all() and run[FAILED[kind]] != 0.0


def test_a_singular_pose_ends_the_forward_program_with_an_error():
    """All joints in one plane: no strut length tells the platform's height to first order."""
    machine = made.example()
    flat = replace(
        machine, base_joints=machine.base_joints * [1, 1, 0], home_tip=np.array([0.0, 0.0, -200.0]), spindle_nose=80.0
    )
    assert np.ptp(np.concatenate([flat.base_joints, flat.platform_joints])[:, 2]) == 0.0
    counts = np.full((1, 6), 1.0)
    run = made.controller_of(flat, "turbo").run(
        "forward", {f"P{motor}": counts[:, 0] for motor in range(1, 7)} | HOMED["turbo"]
    )
    assert run["M5182"] == 1.0 and run["Q300"] == 1.0


@pytest.mark.parametrize("kind", ["turbo", "power"])
def test_the_two_programs_share_no_variable_that_they_compute(kind):
    """A query runs the forward program while the inverse program runs."""
    text = made.text_of(made.screwed(), kind)
    programs = Controller(text, kind).programs
    computed = {
        name: {found[0] for line in lines if (found := re.match(r"Q\d+(?==)", line))}
        for name, lines in programs.items()
    }
    axes = {"Q7", "Q8", "Q9", "Q1", "Q2", "Q3", "Q0"}
    assert not computed["forward"] & computed["inverse"] - axes
    numbers = {int(name[1:]) for names in computed.values() for name in names - axes}
    assert numbers and min(numbers) >= 220 and max(numbers) <= 511


@pytest.mark.parametrize("kind", ["turbo", "power"])
def test_lines_are_ascii_and_as_short_as_the_controller_takes(kind):
    text = made.text_of(made.screwed(), kind)
    assert text.isascii() and max(len(line) for line in text.splitlines()) <= 159


def test_interpreter_refuses_what_it_does_not_know():
    controller = made.controller_of(made.example(), "turbo")
    for line in ("Q5=Q1**Q2", "Q5=2Q1", "GOTO 10", "X10", "Q5=FOO(1)", "Q5=Q49"):
        controller.programs["inverse"] = [line]
        with pytest.raises((SyntaxError, KeyError)):
            controller.run("inverse", NO_SPEEDS["turbo"])
