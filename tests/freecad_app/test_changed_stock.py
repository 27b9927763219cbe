# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operations that CAM does not compute when their stock or model changes are named: it links them to chosen faces only.

CAM itself is the oracle: an operation that is named has another path once it is marked and computed.
"""

import Part
import Path.Op.Profile as Profile
from part_jobs import job_on

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.symmetry import create_mirror


def found(job):
    return [(each.code, each.place.operation, str(each.found)) for each in read_job(job)[1]]


def profiled(document):
    """A job with a profile around a box of 40 x 30 x 10 mm, and its part."""
    job = job_on(document, Part.makeBox(40, 30, 10), "endmill.fcstd", Diameter=5)
    operation = Profile.Create("Profile", parentJob=job)
    operation.ToolController = job.Tools.Group[0]
    document.recompute()
    return job, operation, job.Proxy.baseObject(job, job.Model.Group[0])


def test_an_operation_computed_for_another_stock_is_named(document):
    job, operation, part = profiled(document)
    create_mirror(operation, (1, 0, 0), label="Mirrored")
    document.recompute()
    assert found(job) == []
    part.Shape, before = Part.makeBox(40, 30, 14), operation.Path.toGCode()
    document.recompute()
    assert operation.Path.toGCode() == before
    text = "from Z -1.00 mm to 11.00 mm, now from Z -1.00 mm to 15.00 mm"
    assert found(job) == [("J150", "Profile", text)]  # once, also for its copy
    operation.touch()
    document.recompute()
    assert found(job) == [] and operation.Path.toGCode() != before


def test_sideways_growth_of_the_stock_and_inactive_operations_are_not_named(document):
    job, operation, _ = profiled(document)
    job.Stock.ExtXpos = job.Stock.ExtYneg = 7
    document.recompute()
    assert found(job) == []
    job.Stock.ExtZpos = 7
    operation.Active = False
    document.recompute()
    assert "J150" not in {code for code, *_ in found(job)}
