# SPDX-License-Identifier: LGPL-2.1-or-later
"""CAM's own drilling operation: read, mirrored, and posted to a certified program."""

import FreeCAD as App
import numpy as np
import Part
import Path.Main.Job
import Path.Op.Drilling
import pytest
from cam_jobs import add_operation, job_in_reach, moves
from machines import spindle_axis_text

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.post_job import post_job
from pkm_post.freecad_app.symmetry import create_mirror
from pkm_post.freecad_app.tools import set_gauge_length
from pkm_post.model import EventKind, Kind, Refused
from pkm_post.options.choices import Options

CENTRES = [(10.0, 10.0), (30.0, 10.0), (30.0, 30.0)]
WAYS = {
    "G81": {},
    "G82": {"DwellEnabled": True, "DwellTime": 0.5},
    "G83": {"PeckEnabled": True, "PeckDepth": 3.0},
    "G73": {"PeckEnabled": True, "PeckDepth": 3.0, "chipBreakEnabled": True},
    "G85": {"feedRetractEnabled": True},
}
"""By the cycle that comes out, what is set."""


@pytest.fixture
def job(document):
    return job_on_plate(document, 10.0)


def job_on_plate(document, thickness):
    box = document.addObject("Part::Feature", "Plate")
    box.Shape = Part.makeBox(40, 40, thickness)
    for x, y in CENTRES:
        box.Shape = box.Shape.cut(Part.makeCylinder(2.5, thickness, App.Vector(x, y, 0)))
    document.recompute()
    job = Path.Main.Job.Create("Job", [box], None)
    controller = job.Tools.Group[0]
    controller.SpindleSpeed, controller.SpindleDir, controller.VertFeed = 3000, "Forward", "120 mm/min"
    set_gauge_length(controller, 120)
    return job


def drilling(job, **settings):
    """The operation on all holes; CAM's own ``Create`` looks for a model that is not there yet."""
    operation = job.Document.addObject("Path::FeaturePython", "Drilling")
    operation.Proxy = Path.Op.Drilling.ObjectDrilling(operation, "Drilling", job)
    model = job.Model.Group[0]
    round_faces = [f"Face{n}" for n, face in enumerate(model.Shape.Faces, 1) if isinstance(face.Surface, Part.Cylinder)]
    operation.Base, operation.ToolController = [(model, round_faces)], job.Tools.Group[0]
    for name, value in settings.items():
        setattr(operation, name, value)
    job.Document.recompute()
    return operation


@pytest.mark.parametrize("code", WAYS)
def test_every_hole_is_drilled_to_its_depth(job, code):
    operation = drilling(job, **WAYS[code])
    assert [name for name, _ in moves(operation)].count(code) == len(CENTRES)
    program, faults = read_job(job)
    assert faults == ()
    cutting = program.kind == Kind.LINE
    deepest = program.position[cutting & (program.position[:, 2] == program.position[:, 2].min())]
    assert {tuple(each) for each in deepest[:, :2].tolist()} == set(CENTRES)
    assert deepest[0, 2] == pytest.approx(operation.FinalDepth.Value)
    assert set(program.feed[cutting].tolist()) == {2.0}  # 120 mm/min
    sideways = np.any(np.diff(program.position[:, :2], axis=0) != 0, axis=1)
    assert program.position[:-1, 2][sideways].min() > 10.0  # the top of the plate
    dwells = [event.value for event in program.events if event.kind is EventKind.DWELL]
    assert dwells == [0.5] * (len(CENTRES) if code == "G82" else 0)


def test_holes_that_cam_leaves_out_are_named(job):
    """It skips a hole that is disabled, and after a message in the Report view a face that is no hole."""
    operation = drilling(job)
    ((model, faces),) = operation.Base
    operation.Disabled = [f"{model.Name}.{faces[1]}", f"{model.Name}.Face99"]
    operation.Base = [(model, [*faces, "Face1"])]
    job.Document.recompute()
    assert [name for name, _ in moves(operation)].count("G81") == len(CENTRES) - 1
    found = [(each.code, each.place.operation, each.found) for each in read_job(job)[1]]
    assert found == [("J149", operation.Label, f"holes {model.Label}.{faces[1]}, {model.Label}.Face1")]


@pytest.mark.parametrize("keep_climb", [False, True])
def test_a_mirrored_copy_drills_the_mirrored_holes(job, keep_climb):
    """Whatever is done about climb milling: no hole is drilled from below."""
    operation = drilling(job, **WAYS["G83"])
    copy = create_mirror(operation, (1, 0, 0))
    copy.KeepClimb = keep_climb
    job.Document.recompute()
    assert copy.isValid()
    program, faults = read_job(job)
    assert faults == ()
    half = len(program) // 2
    np.testing.assert_allclose(program.position[half:], program.position[:half] * [-1, 1, 1], atol=1e-9)


def test_drilling_is_posted(document, tmp_path):
    """In a thin plate: where a cutter fits its hole, each step along it is held against the whole wall."""
    job = job_on_plate(document, 3.0)
    drilling(job, PeckEnabled=True, PeckDepth=1.0)
    assert [name for name, _ in moves(job.Operations.Group[0])].count("G83") == len(CENTRES)
    offset = np.eye(4)
    offset[2, 3] = 250.0
    posted = post_job(job, "example_6tps", tmp_path, Options(work_offset=offset))
    assert posted.report["certificate"]["holds"]
    assert [reported.code for reported in posted.diagnostics] == ["J125"], "the offset stands in for the job's fixture"


def test_tapped_holes_are_posted_for_a_spindle_that_is_an_axis(document, tmp_path):
    file = tmp_path / "machine.toml"
    file.write_text(spindle_axis_text(), encoding="utf-8")
    job = job_in_reach(document, top=0.0)
    taps = [f"G84 X{x} Y5 Z-4 R2 F1.25 S600" for x in (5, 10)]
    add_operation(job, ["G0 X0 Y0 Z10", *taps, "G80", "G0 Z20", "G0 X0 Y0", "G1 Z8 F10", "G0 Z30"])
    add_operation(job, ["G0 Z30", *taps, "G80", "G0 Z30"], "Again")
    offset = np.eye(4)
    offset[2, 3] = 250.0
    posted = post_job(job, str(file), tmp_path / "out", Options(work_offset=offset))
    lines = posted.program.read_text(encoding="ascii").splitlines()
    codes = [line for line in lines if line in ("M29", "M28", "S9000 M3", "M5")]
    thread = ["M29", "M28"]
    assert codes == ["S9000 M3", *thread, *thread, "S9000 M3", *thread, *thread, "S9000 M3", "M5"]
    off = next(
        row for row in posted.report["certificate"]["findings"] if row["what"] == "depth of a thread off its turns"
    )
    assert off["holds"]
    with pytest.raises(Refused) as refused:
        post_job(job, "example_6tps", tmp_path / "none", Options(work_offset=offset))
    assert {fault.code for fault in refused.value.diagnostics} >= {"J123"}
