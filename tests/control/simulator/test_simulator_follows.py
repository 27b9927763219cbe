# SPDX-License-Identifier: LGPL-2.1-or-later
"""A posted program on the simulated controller: where the struts go, and where they bring tip and axis."""

import numpy as np
import pytest
from best_segment import deviation_from_any
from programs import ON_PALLET, cone
from simulated import make

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.machine import forward, machine_named
from pkm_post.options.choices import Options
from pkm_post.planning import plan
from pkm_post.posting.steps import post
from pkm_post.writing import trajectory_file

IN_PVT = 1 << 4
LAST_BITS = 2e-6
"""mm: the controller keeps numbers in 36 bits, and the struts of the program have six decimals."""


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    machine, _ = machine_named("example_6tps")
    folder = tmp_path_factory.mktemp("posted")
    return machine, post(cone(12, turns=0.1), machine, folder / "cone.pmc", Options(work_offset=ON_PALLET))


@pytest.fixture(scope="module")
def followed(posted):
    """Places of the struts at each millisecond of the motion after the approach, and the time of the first one, ms."""
    _, made = posted
    pmac = make()
    for name in ("cone-setup.pmc", "cone.pmc"):
        for line in made.program.with_name(name).read_text().splitlines():
            if line.split(";")[0].strip():
                pmac.say(line.split(";")[0].strip())
        if name == "cone-setup.pmc":
            for motor in range(1, 7):
                pmac.say(f"I{motor}11=320000 I{motor}15=10 I{motor}16=6000 I{motor}17=20 I{motor}19=5 I{motor}22=200")
                pmac.say(f"#{motor}J/ HMZ")
    pmac.say("&1B10R")
    while not pmac.system()[1] & IN_PVT:
        assert pmac.runs()
        pmac.wait(1)
    path = pmac.controller.systems[0].path
    since, places = path.time - path.current().start, []
    while pmac.runs():
        places.append(pmac.position())
        pmac.wait(1)
    assert path.abrupt_stops == 0
    return since, np.array(places)


@pytest.mark.slow
def test_the_simulated_machine_keeps_to_the_programmed_path(posted, followed):
    machine, made = posted
    since, places = followed
    trajectory, _ = trajectory_file.read(made.program.with_suffix(".pkmt"))
    tolerances = trajectory.tolerances
    motion = plan(trajectory, machine, tolerances)[0].motion
    time = since + np.arange(len(places))
    inside = time <= motion.time_ms[-1]
    time, places = time[inside], places[inside]
    assert len(time) > 0.99 * motion.time_ms[-1]

    knot = np.clip(np.searchsorted(motion.time_ms, time, side="right") - 1, 0, len(motion) - 2)
    length = motion.tool_length[knot + 1]
    pose = forward(machine, places, length, motion.tip[knot], motion.axis[knot], motion.spin[knot])
    assert pose.converged.all()
    ruler = TrajectoryRuler(trajectory, tolerances)
    tip, axis = deviation_from_any(ruler, pose.tip, pose.axis, motion.segment[knot], motion.segment[knot + 1])

    reported = {finding["what"]: finding["value"] for finding in made.report["certificate"]["findings"]}
    assert tip.max() <= reported["deviation of the tool tip"] + LAST_BITS
    assert np.degrees(axis.max()) <= reported["deviation of the tool axis"] + np.degrees(LAST_BITS / 200)
    assert tip.max() > 0.5 * reported["deviation of the tool tip"]


def test_it_ends_where_the_program_ends(posted, followed):
    machine, made = posted
    trajectory, _ = trajectory_file.read(made.program.with_suffix(".pkmt"))
    last = forward(
        machine, followed[1][-1:], trajectory.tool_length()[-1:], trajectory.tip[-1:], trajectory.axis[-1:],
        trajectory.spin[-1:],
    )  # fmt: skip
    assert np.linalg.norm(last.tip[0] - trajectory.tip[-1]) < LAST_BITS
