# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish measured: gouges and material left, and the tapered column as a whole."""

import math

import FreeCAD as App
import numpy as np
import Part
import pytest
from part_jobs import corner, job_on, load_example
from surface_finishes import AT_G54, CHORD, MICRON, cutting, finish, gap_to, poses, valid

from pkm_post.freecad_app import surface_check
from pkm_post.freecad_app.post_job import post_job
from pkm_post.model import Refused


def step():
    """A floor at z = 10 beside a wall at x = 10."""
    return Part.makeBox(40, 20, 10).fuse(Part.makeBox(10, 20, 30)).removeSplitter()


def floor(face):
    """Whether it is that floor."""
    return face.BoundBox.XMin > 9.9 and abs(face.BoundBox.ZMax - 10) < 0.1 and face.normalAt(0, 0).z > 0.9


@pytest.mark.parametrize("spacing", [3.0, 1.5])
def test_ridges_are_found_where_the_spacing_fits_the_passes(document, spacing):
    # Passes of a ball of R 5, as far apart as the points or half as far: a grid alone lies on the passes.
    job = job_on(document, Part.makeBox(30, 30, 10))
    operation = valid(finish(job, lambda face: abs(face.BoundBox.ZMin - 10) < 0.1, Stepover=1.5, CheckSpacing=spacing))
    ridge = 5.0 - math.sqrt(5.0**2 - 0.75**2)
    assert 0.8 * ridge < operation.MaximumExcess < ridge + MICRON


def test_nothing_is_posted_over_a_gouge(document, tmp_path, monkeypatch):
    monkeypatch.setattr(surface_check, "_MOST_CLOSE", 1000)  # the grid finds it
    job = job_on(document, step())
    operation = finish(job, floor, Stepover=4.0, CheckSpacing=2.0)
    assert not operation.isValid()
    assert "5 mm at X 10 mm, Y " in operation.getStatusString()
    assert operation.Path.Size == 0
    with pytest.raises(Refused) as refused:
        post_job(job, "example_6tps", tmp_path, AT_G54)
    assert "J116" in [fault.code for fault in refused.value.diagnostics]
    assert not any(tmp_path.iterdir())


@pytest.fixture(scope="module")
def gouging():
    """A ball of R 5, upright over a floor up to the wall beside it: its axis comes to the wall, and it cuts R deep.

    The operation, and what was measured as it was computed first.
    """
    document = App.newDocument("gouging")
    operation = finish(job_on(document, step()), floor, Stepover=2.0, CheckSpacing=1.0)
    yield operation, operation.Proxy.measured
    App.closeDocument(document.Name)


def test_every_measured_point_is_kept_for_the_map(gouging):
    operation, found = gouging
    assert found.depth.max() == operation.MaximumGouge == pytest.approx(5.0, abs=0.01)
    ours = np.isfinite(found.left)
    assert found.left[ours].max() == operation.MaximumExcess
    np.testing.assert_allclose(found.points[ours][:, 2], 10.0)  # only the floor is to be covered
    assert (found.points[~ours][:, 0] <= 10.0 + MICRON).any()  # the wall beside it is measured as well
    # triangles cover the floor whole, and the other faces but for cells across the border of the L-shaped ones
    a, b, c = (found.points[found.triangles[:, corner]] for corner in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    assert area[ours[found.triangles].all(axis=1)].sum() == pytest.approx(30 * 20, rel=1e-6)
    assert area.sum() == pytest.approx(sum(face.Area for face in step().Faces), rel=0.01)


def test_gouge_and_material_left_are_reported_with_their_places(gouging):
    operation, _ = gouging
    assert "N311" in operation.getStatusString()
    assert operation.MaximumGouge == pytest.approx(5.0, abs=0.01)
    assert operation.GougePoint.x == pytest.approx(10.0)
    assert operation.GougePoint.z > 10.0
    assert operation.MaximumExcess < 5.0 - math.sqrt(5.0**2 - 1.0) + MICRON
    assert operation.ExcessPoint.z == pytest.approx(10.0)
    operation.CheckSpacing = 0
    operation.Document.recompute()
    assert (valid(operation).MaximumGouge, operation.MaximumExcess) == (-1.0, -1.0)


@pytest.fixture(scope="module")
def column():
    """The wall of the column finished with its bull nose, 31 degrees off it and 8 degrees forward."""
    example = load_example()
    document = App.newDocument("column")
    solid = example.solid(example.Column())
    job = job_on(document, solid, "bullnose.fcstd", Diameter=16, **corner(16.0, 4.0))
    operation = finish(
        job,
        lambda face: face.Surface.TypeId != "Part::GeomPlane",
        Lead=8.0,
        Tilt=59.0,
        Stepover=4.0,
        ChordTolerance=CHORD,
        Reversed=True,
        Order="One way",
        CutMode="Climb",
        LeadMove="Arc",
        CheckSpacing=3.0,
    )
    yield valid(operation), job, example.wall(solid)
    App.closeDocument(document.Name)


@pytest.mark.slow
def test_column_is_neither_gouged_nor_left_beyond_the_tolerance(column):
    """Measured by OpenCASCADE, at the ends and in the middle of moves."""
    operation, _, wall = column
    gaps = [gap_to(wall, tip, axis) for tip, axis in list(zip(*cutting(operation), strict=True))[::23]]
    assert len(gaps) > 200
    assert min(gaps) > -CHORD
    assert max(gaps) < CHORD


def test_column_is_checked_by_the_operation_itself(column):
    operation, _, _ = column
    assert operation.MaximumGouge < CHORD
    # scallops of passes 4 mm apart, cut by a corner of 4 mm
    assert operation.MaximumExcess < 4.0 - math.sqrt(4.0**2 - 2.0**2) + CHORD


def test_column_is_climbed_round_from_the_top(column):
    tips, _ = poses(column[0], ("G1",))
    turn = np.cross(tips[:-1], tips[1:])[:, 2]
    assert np.mean(turn < 0) > 0.99
    assert tips[100, 2] > tips[-100, 2]


def test_column_keeps_its_tilt_from_the_wall(column):
    operation, _, _ = column
    _, axes = poses(operation, ("G1",))
    tilt = np.degrees(np.arccos(axes[:, 2]))
    assert tilt.max() < 25.0


def test_column_is_posted_to_a_certified_program(column, tmp_path):
    operation, job, _ = column
    posted = post_job(job, "example_6tps", tmp_path, AT_G54)
    assert {"pmc", "pkmt", "json"} <= {path.suffix[1:] for path in posted.files}
    assert posted.program.stat().st_size > 100_000
    assert operation.isValid()
