# SPDX-License-Identifier: LGPL-2.1-or-later
"""The macro that makes a lap of a quadrant, and the tapered column with its mirrored quadrants run the other way."""

import math
import runpy
import sys
from pathlib import Path

import FreeCAD as App
import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "freecad_app"))

from cam_jobs import add_operation, new_job  # noqa: E402

from examples.tapered_column.build import Column, build  # noqa: E402
from pkm_post.freecad_app.document_object import program_of  # noqa: E402
from pkm_post.freecad_app.symmetry_report import family_of  # noqa: E402
from pkm_post.toolpath.symmetry.passes import pass_rows  # noqa: E402

QUARTER = ["G0 X60 Y0 Z90", "G0 Z40", "G1 Z30 F5", "G3 X0 Y60 I-60 J0 F20", "G0 Z40", "G0 Z90"]
SIX_DECIMALS = 1e-6


@pytest.fixture
def lap():
    """The operations that the macro leaves in a document with a quarter of a ring."""
    document = App.newDocument("ring")
    job = new_job(document)
    add_operation(job, QUARTER)
    runpy.run_path(str(ROOT / "examples" / "four_quadrants.py"), run_name="__main__")
    yield job.Operations.Group
    App.closeDocument(document.Name)


def test_the_macro_makes_one_lap(lap):
    programs = [program_of(operation) for operation in lap]
    rows = [pass_rows(program)[0] for program in programs]
    begins = [program.position[first - 1] for program, (first, _) in zip(programs, rows, strict=True)]
    ends = [program.position[behind - 1] for program, (_, behind) in zip(programs, rows, strict=True)]
    np.testing.assert_allclose(np.roll(begins, -1, axis=0), ends, atol=SIX_DECIMALS)
    family = family_of(lap[0])
    assert (family.members, family.coverage.tiles, len(family.joints)) == (4, True, 4)
    senses = [program.arc_axis[first, 2] for program, (first, _) in zip(programs, rows, strict=True)]
    assert senses == [1, 1, 1, 1]  # all counterclockwise


def test_mirrored_quadrants_of_the_tapered_column_can_be_run_the_other_way():
    document, job = build(Column(spacing=6.0, stepover=20.0))
    before = {item.Label: program_of(item).position for item in job.Operations.Group}
    mirrored = [item for item in job.Operations.Group if hasattr(item, "KeepClimb")]
    for item in mirrored:
        item.KeepClimb = True
    document.recompute()
    assert [item.isValid() for item in mirrored] == [True, True], mirrored[0].getStatusString()
    for item in mirrored:
        np.testing.assert_allclose(program_of(item).position, before[item.Label][::-1], atol=SIX_DECIMALS)
    found = family_of(mirrored[0]).coverage
    assert math.degrees(found.covered) == pytest.approx(360, abs=0.01)
    App.closeDocument(document.Name)
