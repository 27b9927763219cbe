# SPDX-License-Identifier: LGPL-2.1-or-later
"""The best position of a part: laws of an optimum, and a job that can only be cut where the search puts it."""

import numpy as np
import pytest
from programs import ON_PALLET, cone

from pkm_post.machine.description.presets import machine_named
from pkm_post.machine.reach.best_position import best_position
from pkm_post.machine.spin.normalised_margins import SampledPoses, normalised_margins
from pkm_post.machine.spin.policy import JOINTS, STROKE
from pkm_post.toolpath.place import place


@pytest.fixture(scope="module")
def machine():
    return machine_named("example_6tps")[0]


def shifted(by):
    offset = ON_PALLET.copy()
    offset[:3, 3] += by
    return offset


def least_shares(trajectory, machine):
    samples = SampledPoses.of(trajectory)
    cut = samples.s >= samples.row_s[0]
    pose = samples.tip[cut], samples.axis[cut], np.zeros(cut.sum()), samples.tool_length[cut]
    return normalised_margins(machine, *pose).min(axis=0)


def placed(machine, offset):
    return place(cone(120), machine, offset)[0]


@pytest.mark.slow
def test_what_is_reported_is_what_the_new_work_offset_gives(machine):
    trajectory = placed(machine, shifted([120.0, -60.0, 40.0]))
    found = best_position(trajectory, machine)
    assert found.before == pytest.approx(least_shares(trajectory, machine))
    assert found.after == pytest.approx(least_shares(placed(machine, found.machine_from_work), machine), abs=1e-9)
    assert found.after[STROKE] > found.before[STROKE] + 0.1


@pytest.mark.slow
def test_no_small_move_improves_it(machine):
    found = best_position(placed(machine, ON_PALLET), machine)
    for column in range(3):
        for step in (-2.0, 2.0):
            moved = found.machine_from_work.copy()
            moved[column, 3] += step
            assert least_shares(placed(machine, moved), machine)[STROKE] < found.after[STROKE] + 1e-4


@pytest.mark.slow
def test_it_does_not_matter_where_the_search_begins(machine):
    worst = [
        best_position(placed(machine, shifted(by)), machine).after[STROKE]
        for by in ([0.0, 0.0, 0.0], [100.0, 80.0, -50.0], [-150.0, 30.0, 60.0])
    ]
    assert np.ptp(worst) < 0.02


def test_what_is_not_free_stays(machine):
    start = shifted([50.0, 20.0, 10.0])
    found = best_position(placed(machine, start), machine, free="xy").machine_from_work
    assert found[2, 3] == pytest.approx(start[2, 3])
    assert found[:3, :3] == pytest.approx(np.eye(3))
    assert np.abs(found[:2, 3] - start[:2, 3]).max() > 1.0


@pytest.mark.slow
def test_another_share_may_count(machine):
    trajectory = placed(machine, shifted([80.0, 0.0, 0.0]))
    found = best_position(trajectory, machine, weights={JOINTS: 1.0})
    assert found.after[JOINTS] > found.before[JOINTS]


@pytest.mark.slow
def test_a_job_out_of_reach_is_brought_into_reach(machine):
    far = placed(machine, shifted([320.0, 0.0, 0.0]))
    found = best_position(far, machine)
    assert found.before.min() < 0 < found.after.min()


@pytest.mark.slow
def test_the_work_offset_stays_a_rotation_with_a_shift(machine):
    found = best_position(placed(machine, ON_PALLET), machine, free="xyzabc").machine_from_work
    assert found[:3, :3] @ found[:3, :3].T == pytest.approx(np.eye(3))
    assert np.linalg.det(found[:3, :3]) == pytest.approx(1.0)


@pytest.mark.parametrize("free", ["", "xq"])
def test_letters_that_mean_nothing_are_a_fault_of_the_caller(machine, free):
    with pytest.raises(ValueError, match="expected letters of 'xyzabc'"):
        best_position(placed(machine, ON_PALLET), machine, free=free)


def test_a_mirror_symmetric_machine_wants_the_part_in_its_middle(machine):
    # The example machine is symmetric about its xz plane and so is the cone: y = 0 is as good as any.
    found = best_position(placed(machine, shifted([0.0, 90.0, 0.0])), machine, free="y")
    assert abs(found.machine_from_work[1, 3]) < 1.0
