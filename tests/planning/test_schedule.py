# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
from machines import example
from programs import ON_PALLET, cone, program

from pkm_post.model import Event, EventKind
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan_feed
from pkm_post.toolpath.place import place


def schedule_of(made):
    trajectory, _ = place(made, example(), ON_PALLET)
    feed_plan, faults = plan_feed(trajectory, example(), Tolerances(1e-3, np.radians(1e-3)))
    assert not faults
    return trajectory, feed_plan.path, feed_plan.schedule


def stop_and_go():
    return program(
        [[0, 0, 60], [10, 0, 60], [10, 10, 60], [0, 10, 60]],
        events=(Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.DWELL, 0.5), Event(4, EventKind.SPINDLE, 0)),
    )


def test_speed_is_the_derivative_of_the_way():
    _, _, schedule = schedule_of(cone())
    time = np.linspace(0.01, schedule.law.time[-1] - 0.01, 2000)
    step = 1e-6
    s, speed, _ = schedule.at(time)
    np.testing.assert_allclose((schedule.at(time + step)[0] - schedule.at(time - step)[0]) / (2 * step), speed,
                               atol=5e-3)  # fmt: skip
    assert np.all(np.diff(s) >= 0)


def test_rests_are_whole_milliseconds_at_rest():
    trajectory, path, schedule = schedule_of(stop_and_go())
    s, speed, _ = schedule.at(schedule.rests_ms / 1000)
    np.testing.assert_allclose(speed, 0, atol=1e-9)
    np.testing.assert_array_equal(schedule.rest_joints, [0, 2, 4])
    np.testing.assert_allclose(s, path.starts[schedule.rest_joints], atol=1e-9)
    assert trajectory.exact_stop.tolist() == [False, True, False, True]


def test_feed_is_kept_and_reached():
    _, path, schedule = schedule_of(program([[0, 0, 60], [0, 0, 50], [100, 0, 50]], feed=30.0))
    cutting = schedule.law.s > path.starts[1]
    assert 29.9 < schedule.law.speed[cutting].max() <= 30.0


def test_when_a_place_is_passed_is_when_the_motion_law_is_there():
    _, _, schedule = schedule_of(stop_and_go())
    law = schedule.law
    s = np.sort(np.random.default_rng(4).uniform(0, law.s[-1], 2000))
    time = law.when(s)
    np.testing.assert_allclose(law.at(time)[0], s, atol=1e-9)
    assert np.all(np.diff(time) > 0)
    np.testing.assert_allclose(law.when(law.s[1:]), law.time[1:], atol=1e-9)
