# SPDX-License-Identifier: LGPL-2.1-or-later
"""Velocity and acceleration of the tool from those of the struts: the way back of ``strut_rates``."""

import numpy as np
import pytest
from machines import example, genhexkins, screwed
from test_rates import wandering_poses

from pkm_post.machine.kinematics.inverse import angular_rates, platform_rotation
from pkm_post.machine.kinematics.rates import strut_rates, tool_rates

TIMES = np.linspace(0, 6, 200)


@pytest.mark.parametrize("machine", [example(), screwed(example()), genhexkins()], ids=["keyed", "screwed", "inch"])
def test_the_struts_of_a_motion_give_its_velocity_and_acceleration_back(machine):
    poses = wandering_poses(TIMES)
    _, speed, acceleration = strut_rates(machine, poses)
    turn, turn_1 = angular_rates(poses.axis, poses.axis_1, poses.axis_2, poses.spin_1, poses.spin_2)
    rotation = platform_rotation(poses.axis, poses.spin)
    twist, twist_rate = tool_rates(machine, poses.tip, rotation, poses.tool_length, speed, acceleration)
    np.testing.assert_allclose(twist, np.column_stack([poses.tip_1, turn]), atol=1e-9)
    np.testing.assert_allclose(twist_rate, np.column_stack([poses.tip_2, turn_1]), atol=1e-8)
