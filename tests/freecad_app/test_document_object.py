# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is refused is reported without the way through the code; what is our own fault is reported with it."""

import re
from types import SimpleNamespace

import pytest
from cam_jobs import add_operation
from part_jobs import ROOT

from pkm_post.freecad_app import machine_object, program_object, reach_object, simulation_object
from pkm_post.freecad_app.document_object import without_traceback
from pkm_post.freecad_app.reach_object import create_reach
from pkm_post.freecad_app.symmetry import create_mirror
from pkm_post.model import Diagnostic, Place, Refused

REFUSED = Refused([Diagnostic("J121", Place("part.FCStd", "Mirror"), "no direction")])


@pytest.mark.parametrize(("fault", "last"), [(REFUSED, "brief"), (ValueError("expected 3, got 2"), "deep")])
def test_only_what_is_refused_is_reported_briefly(fault, last):
    def deep():
        raise fault

    @without_traceback
    def execute(proxy, obj):
        deep()

    with pytest.raises(type(fault)) as reported:
        execute(None, SimpleNamespace(Label="Mirror"))
    assert reported.traceback[-1].name == last
    assert str(reported.value) == str(fault)


def test_a_machine_that_is_not_there_is_reported_at_the_object(job):
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", "--machine no_such_machine"
    reach = create_reach(job)
    job.Document.recompute()
    assert not reach.isValid()
    assert "M101" in reach.getStatusString()


def test_a_plane_without_a_direction_is_reported_at_the_object(job):
    copy = create_mirror(add_operation(job), (0, 0, 0))
    job.Document.recompute()
    assert not copy.isValid()
    assert "J121" in copy.getStatusString()


OBJECTS = {
    "Machine": machine_object.MachineObject,
    "Reach": reach_object.ReachObject,
    "Simulation": simulation_object.SimulationObject,
    "Part programs": program_object.PartProgram,
}


@pytest.mark.parametrize("title", OBJECTS)
def test_the_page_lists_every_property_that_a_user_sees(title):
    page = (ROOT / "docs" / "workbench.md").read_text(encoding="utf-8")
    section = page.partition(f"\n## {title}\n")[2].partition("\n## ")[0]
    proxy, hidden = OBJECTS[title], reach_object.PATH_PROPERTIES
    names = {row[1] for row in (*proxy.properties, *proxy.results) if row not in hidden}
    within = {f"Strut{number}" for number in range(2, 6)}  # of `Strut1` to `Strut6`
    assert names - within - set(re.findall(r"`(\w+)`", section)) == set()
