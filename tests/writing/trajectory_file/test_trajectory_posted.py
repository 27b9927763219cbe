# SPDX-License-Identifier: LGPL-2.1-or-later
"""What posting leaves in the trajectory file."""

from programs import cone

from pkm_post.machine import find_machine
from pkm_post.machine.description.reader import read_machine
from pkm_post.model.certificate import Tolerances
from pkm_post.options.choices import Options
from pkm_post.posting.steps import post
from pkm_post.writing.trajectory_file import read


def test_the_tolerances_that_were_asked_for_are_in_the_file(tmp_path):
    asked = Tolerances(2e-3, 4e-5)
    machine, _ = read_machine(find_machine("example_6tps"))
    options = Options(tip_tolerance=asked.tip, axis_tolerance=asked.axis)
    post(cone(8), machine, tmp_path / "part.pmc", options)
    trajectory, _ = read(tmp_path / "part.pkmt")
    assert trajectory.tolerances == asked
