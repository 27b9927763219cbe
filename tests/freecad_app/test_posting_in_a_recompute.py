# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job that is posted inside a recompute, as by a timer that fires while the progress bar lets the window work."""

import Part
import pytest
from cam_jobs import add_operation, job_in_reach

from pkm_post.freecad_app.job_setup import study_job
from pkm_post.freecad_app.post_job import post_job
from pkm_post.freecad_app.simulation import simulate_job
from pkm_post.model import Refused


class Calls:
    """A part that calls a function whenever it is computed; operations that stand on it are computed later."""

    def __init__(self, obj):
        self.call, self.refused = (lambda: None), []
        obj.Proxy = self

    def execute(self, obj):
        obj.Shape = Part.makeBox(20, 20, 20)
        try:
            self.call()
        except Refused as refused:
            self.refused += [each.code for each in refused.diagnostics]


@pytest.fixture
def part(document):
    made = document.addObject("Part::FeaturePython", "Part")
    return made, Calls(made)


@pytest.mark.parametrize("call", [post_job, study_job, simulate_job])
def test_paths_that_are_not_yet_computed_are_not_used(document, part, call, tmp_path):
    feature, proxy = part
    job = job_in_reach(document)
    operation = add_operation(job)
    operation.addProperty("App::PropertyLink", "Under").Under = feature
    document.recompute()
    assert operation.State == ["Up-to-date"]
    proxy.call = lambda: call(job, out=tmp_path) if call is post_job else call(job)
    feature.touch()
    document.recompute()
    assert proxy.refused == ["J137"]
    assert list(tmp_path.iterdir()) == []
    proxy.call()  # and afterwards it is done
