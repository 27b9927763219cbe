# SPDX-License-Identifier: LGPL-2.1-or-later
"""The main job to its end: the posted column is downloaded over a link, runs, and the tool is where it was programmed.

Here it is the upper four millimetres of the column, in all four quadrants; the whole of it takes minutes and is driven
by ``column_over_links.py``. What is shorter is the number of passes: they are built, posted and certified alike.
"""

import functools
import importlib.util
import json
import re
import sys
from pathlib import Path

sys.path += [str(Path(__file__).parents[1] / "control" / room) for room in ("link", "numerical_control", "player")]

import FreeCAD as App
import pytest
from column_over_links import follow
from operated import MACHINE, check, play_operated
from Path.Post.Processor import PostProcessorFactory

from pkm_post.control.player.playable import read_playable
from pkm_post.machine import find_machine

EXAMPLE = Path(__file__).parents[2] / "examples" / "tapered_column"
LOWEST = 76.0
"""mm: the column is 80 mm high, and its passes are 2.5 mm apart."""
LAST_BITS = 2e-6
"""mm: the controller keeps numbers in 36 bits, and the struts of the program have six decimals."""
LINKS = pytest.mark.parametrize("kind", ["tcp", "serial", "ssh"])
COUNT = 1e-4
"""mm: what the encoder of the example counts."""


@pytest.fixture(scope="module")
def power_machine(tmp_path_factory):
    """The example machine with a Power PMAC."""
    file = tmp_path_factory.mktemp("machine") / "power.toml"
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    file.write_text(text.replace('kind = "turbo_pmac"', 'kind = "power_pmac"'), encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    """Posts the upper part of the column for a machine as CAM's Post Process command does it, once for all links."""
    return functools.cache(lambda machine: _program(tmp_path_factory.mktemp("upper"), machine))


def _program(folder, machine):
    spec = importlib.util.spec_from_file_location("tapered_column_build_upper", EXAMPLE / "build.py")
    build = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = build
    spec.loader.exec_module(build)
    document, job = build.build(build.Column(lowest_contact=LOWEST), out=folder)
    job.PostProcessorArgs = re.sub(r"--machine \S+", "", job.PostProcessorArgs) + f" --machine {machine}"
    job.PostProcessorOutputFile = str(folder / "upper.pmc")
    PostProcessorFactory.get_post_processor(job, "hexapod_pmac").export()
    App.closeDocument(document.Name)
    return folder / "upper.pmc"


@LINKS
def test_the_tool_keeps_to_the_programmed_path_within_the_certificate(kind, posted, power_machine):
    machine = power_machine if kind == "ssh" else "example_6tps"
    program = posted(machine)
    report = json.loads(program.with_name("upper-report.json").read_text())
    reported = {finding["what"]: finding["value"] for finding in report["certificate"]["findings"]}
    followed = follow(program, kind, machine=machine)
    assert followed.part > 0.99 and followed.samples > 1000 and followed.words == ()
    assert followed.off < LAST_BITS
    assert followed.tip <= reported["deviation of the tool tip"] <= report["tolerances"]["tip_mm"]
    assert followed.axis <= reported["deviation of the tool axis"] <= report["tolerances"]["axis_deg"]
    assert followed.tip > 0.9 * reported["deviation of the tool tip"]  # it is the path that was measured
    assert followed.end < COUNT


@pytest.mark.slow
@LINKS
def test_the_same_when_it_is_played_and_its_operator_never_rests(kind, posted):
    program = posted("example_6tps")
    trajectory, tolerances, faults = read_playable(program.with_suffix(".pkmt"), MACHINE)
    assert not faults
    follower, operator, results = play_operated(trajectory, tolerances, kind)
    check(follower, results, MACHINE)
    counts = {what: operator.done.count(what) for what in set(operator.done)}
    assert counts["hold"] == 10 and counts["override"] > 5 and (counts["break"], counts["abort"]) == (1, 1)
    assert {"waits: hold", "waits: override 0"} <= operator.phases and len(results) == 2
