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


def test_a_job_by_stages_has_the_motion_of_its_post(job, tmp_path):
    (posted,) = pkm.post(job, out=tmp_path / "posted")
    machine, program = pkm.read_machine(), pkm.read(job)
    trajectory = pkm.place(program, machine, pkm.read_options("--work-offset=0,0,250"))
    pkm.write(trajectory, tmp_path / "staged.pkmt")
    stored = posted.program.with_suffix(".pkmt").read_bytes()
    assert (tmp_path / "staged.pkmt").read_bytes() == stored
