# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program for LinuxCNC's hexapod says of corners what the trajectory says."""

import dataclasses

from machines import example
from programs import BALL, ON_PALLET, program

from pkm_post.gcode import ReadOptions, read
from pkm_post.outputs import linuxcnc_text
from pkm_post.placement import place


def test_stops_and_tolerances_of_the_trajectory_are_in_the_program_for_linuxcnc():
    made = program([[0, 0, 60], [9, 0, 60], [9, 9, 60], [0, 9, 60], [0, 0, 60]])
    told = dataclasses.replace(made, exact_path=[False, True, False, False, False], tip_tolerance=[0, 0, 0, 0.05, 0])
    trajectory, _ = place(told, example(), ON_PALLET)
    assert trajectory.exact_stop.tolist() == [True, True, False, False, True]
    text, faults = linuxcnc_text(trajectory, 0.001)
    assert not faults
    back, _ = read(text, "part.ngc", ReadOptions(axis_words="RPY", default_tool=BALL))
    assert back.exact_stop.tolist() == trajectory.exact_stop.tolist()
    assert back.tip_tolerance.tolist() == [0.0, 0.0, 0.001, 0.05, 0.0]  # exact stops have none
