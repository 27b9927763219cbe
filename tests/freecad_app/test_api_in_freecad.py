# SPDX-License-Identifier: LGPL-2.1-or-later
"""The public API inside FreeCAD: its examples, and a CAM job by stages against ``post``."""

import doctest
import inspect
import math

import FreeCAD
import Part
import pytest
from cam_jobs import add_operation, job_in_reach

import pkm_post as pkm
from pkm_post import api

IN_FREECAD = [
    each for each in vars(api).values() if inspect.isfunction(each) and "# in FreeCAD" in (each.__doc__ or "")
]


@pytest.fixture
def job(tmp_path):
    document = FreeCAD.newDocument("api")
    made = job_in_reach(document)
    add_operation(made)
    document.recompute()
    FreeCAD.setActiveDocument(document.Name)
    yield made
    FreeCAD.closeDocument(document.Name)


def test_examples_give_what_they_say(job):
    """In one document and in the order of the page: the copies that one example makes are counted by the next."""
    names = {"pkm": pkm, "FreeCAD": FreeCAD, "Part": Part, "math": math}
    said = []
    assert len(IN_FREECAD) >= 6
    for function in IN_FREECAD:
        test = doctest.DocTestParser().get_doctest(function.__doc__, names, function.__name__, None, 0)
        doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(test, out=said.append)
    assert not said, "".join(said)


@pytest.mark.parametrize(
    ("call", "error", "said"),
    [
        (lambda job, operation: pkm.jobs("part.FCStd"), TypeError, "document: expected a FreeCAD document, got str"),
        (lambda job, operation: pkm.job(None), TypeError, "document: expected a FreeCAD document, got NoneType"),
        (lambda job, operation: pkm.read(job.Document), TypeError, "source: expected the path of a file or a CAM job"),
        (lambda job, operation: pkm.post(operation), TypeError, "source: expected the path of a file or a CAM job"),
        (lambda job, operation: pkm.mirror(None, (1, 0, 0)), TypeError, "operation: expected an operation"),
        (lambda job, operation: pkm.mirror(job, (1, 0, 0)), TypeError, "got the job itself"),
        (lambda job, operation: pkm.mirror(operation, (0, 0, 0)), ValueError, "normal: .* not all zero"),
        (lambda job, operation: pkm.mirror(operation, (1, 0)), ValueError, "normal: expected three numbers"),
        (lambda job, operation: pkm.mirror(operation, (math.nan, 0, 0)), ValueError, "normal: expected three numbers"),
        (lambda job, operation: pkm.mirror(operation, "XZ"), ValueError, "XZ|X"),
        (lambda job, operation: pkm.mirror(operation, (1, 0, 0), (0, math.inf, 0)), ValueError, "point: expected"),
        (lambda job, operation: pkm.rotate(operation, (0, 0, 0), 1.0), ValueError, "axis: .* not all zero"),
        (lambda job, operation: pkm.rotate(operation, (0, 0, 1), math.nan), ValueError, "angle: expected a number"),
        (lambda job, operation: pkm.rotate(operation, (0, 0, 1), "180"), TypeError, "real number, not str"),
        (lambda job, operation: pkm.symmetry(job), TypeError, "got the job itself"),
        (lambda job, operation: pkm.set_gauge_length(operation, 120.0), TypeError, "controller: expected a tool contr"),
        (
            lambda job, operation: pkm.surface_points(Part.makeBox(1, 1, 1), [0], [0]),
            TypeError,
            "face: expected a face",
        ),
        (lambda job, operation: pkm.add_machine(None), TypeError, "document: expected a FreeCAD document"),
        (lambda job, operation: pkm.add_machine(job.Document, job=operation), TypeError, "job: expected a CAM job"),
    ],
)
def test_a_wrong_argument_is_named_and_nothing_is_added(job, call, error, said):
    before = [each.Name for each in job.Document.Objects]
    with pytest.raises(error, match=said):
        call(job, job.Operations.Group[0])
    assert [each.Name for each in job.Document.Objects] == before


@pytest.mark.parametrize("length", [-5.0, 0, math.nan, math.inf, 1e9, "long"])
def test_a_gauge_length_that_is_none_is_not_set(job, length):
    controller = job.Tools.Group[0]
    before = controller.GaugeLength
    with pytest.raises(ValueError, match="length: expected a number above 0|could not convert"):
        pkm.set_gauge_length(controller, length)
    assert controller.GaugeLength == before


def test_vectors_of_freecad_and_generators_are_directions(job):
    operation = job.Operations.Group[0]
    made = pkm.mirror(operation, FreeCAD.Vector(1, 0, 0)), pkm.mirror(operation, (each for each in (1, 0, 0)), label=5)
    assert made[1].Label == "5"
    assert pkm.add_machine(job.Document, pkm.find_machine("example_6tps")).Label == "Machine Example 6-TPS"


def test_a_job_by_stages_has_the_motion_of_its_post(job, tmp_path):
    (posted,) = pkm.post(job, out=tmp_path / "posted")
    machine, program = pkm.read_machine(), pkm.read(job)
    trajectory = pkm.place(program, machine, pkm.read_options("--work-offset=0,0,250"))
    pkm.write(trajectory, tmp_path / "staged.pkmt")
    stored = posted.program.with_suffix(".pkmt").read_bytes()
    assert (tmp_path / "staged.pkmt").read_bytes() == stored
