# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish (5-axis): a CAM operation that covers faces with passes of a tilted tool.

Takes faces, a tool controller and properties; sets the ``Path`` of the tool tip, with the tool axis as I J K words. It
works like CAM's own operations: CAM's base class handles tool controller, heights and coolant. Saved documents store
the class as ``pkm_post.freecad_app.surface_finish``: its module, its name and the names of its properties are a file
format.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import FreeCAD as App
import Path
import Path.Op.Base

from pkm_post.freecad_app.commands import commands_of
from pkm_post.freecad_app.document import document_name, members
from pkm_post.freecad_app.document_object import value_of, without_traceback
from pkm_post.freecad_app.face_surface import face_surface
from pkm_post.freecad_app.model_faces import NamedFace, model_faces
from pkm_post.freecad_app.progress import Progress
from pkm_post.freecad_app.surface_check import Checked, check_faces
from pkm_post.freecad_app.surface_finish_choice import choose_lead_and_cone
from pkm_post.freecad_app.surface_finish_settings import CHECK_SPACING, add_missing_properties, read_inputs
from pkm_post.freecad_app.tools import has_upright_side, preselected
from pkm_post.freecad_app.window import add_view
from pkm_post.model import Amount, Diagnostic, Phrase, Place, Program, Refused
from pkm_post.toolpath import Cutter, SurfaceOptions, SurfacePoses, program_from_poses, surface_poses

_STEPS = 50
"""Steps of the progress bar per face."""
_GOUGE_FACTOR = 1.1
"""Depth in ChordTolerance beyond which a gouge is a fault: the measurement is accurate to a tenth of that."""
_MAX_EXCESS = 2.0
"""mm: larger excess is not measured."""

_FEATURES = (
    Path.Op.Base.FeatureTool | Path.Op.Base.FeatureHeights | Path.Op.Base.FeatureBaseFaces | Path.Op.Base.FeatureCoolant
)


class SurfaceFinish(Path.Op.Base.ObjectOp):
    """The operation. Faults raise exceptions, which FreeCAD shows at the object, and its path is then empty.

    Attributes:
        measured: the last measurement, point by point; None without one, and after the document was reopened.
    """

    measured: Checked | None = None

    def opFeatures(self, obj: Any) -> int:
        """Features handled by CAM's base class."""
        return int(_FEATURES)

    def initOperation(self, obj: Any) -> None:
        """Add the properties of a new object, whose gouges are measured."""
        add_missing_properties(obj)
        obj.CheckSpacing = CHECK_SPACING

    def opOnDocumentRestored(self, obj: Any) -> None:
        """Add the properties that documents of older versions lack."""
        add_missing_properties(obj)

    def isToolSupported(self, obj: Any, tool: Any) -> bool:
        """Whether the operation supports a tool bit; CAM's panel calls this."""
        return has_upright_side(tool)

    @without_traceback
    def execute(self, obj: Any) -> Any:
        """Recompute the path; after an error no stale path may be posted."""
        obj.Path = Path.Path()
        self.measured = None
        if obj.Active and (obj.ToolController is None or obj.ToolController.Tool is None):
            raise Refused([Diagnostic("J112", _place(obj), Phrase("none is set"))])
        return super().execute(obj)

    def opExecute(self, obj: Any) -> None:
        """Fill the list of commands: called by the base class once tool and job are known."""
        place = _place(obj)
        faces, cutter, settings = value_of(read_inputs(obj, self.job, place))
        poses = _poses_over(faces, cutter, settings, bool(obj.FlipNormals), place)
        program = value_of(program_from_poses(poses, settings, place))
        _set_results(obj, poses, settings)
        self.measured = _measured(obj, program, cutter, faces, self.job)
        _judge(obj, self.measured)
        self.commandlist += commands_of(program)


def create_surface_finish(
    job: Any,
    faces: Iterable[tuple[Any, Sequence[str]]] = (),
    label: str = "Surface Finish",
    controller: Any = None,
    fit: bool = False,
) -> Any:
    """Add the operation to a job. It is computed with the document.

    Args:
        faces: pairs of an object of the job's model and names of its faces, such as ``(clone, ["Face1"])``.
        controller: the tool controller; if None, the first one of the job with a supported tool; if there is none, CAM
            opens its dialog in the GUI; without a GUI the first one is taken.
        fit: whether to choose lead and cone limit by faces, tool and machine, like the button.

    Raises:
        Refused: the job has no tool controller with a tool, or none is chosen in the dialog, J112.
    """
    usable = [each for each in members(job.Tools) if each.Tool is not None]
    controller = controller or next((each for each in usable if has_upright_side(each.Tool)), None)
    none = Refused([Diagnostic("J112", Place(document_name(job.Document), job.Label), Phrase("none is set"))])
    if controller is None and not usable:
        raise none
    obj = job.Document.addObject("Path::FeaturePython", "SurfaceFinish")
    with preselected(controller or (None if App.GuiUp else usable[0])):
        try:
            obj.Proxy = SurfaceFinish(obj, "SurfaceFinish", job)
        except Path.Op.Base.PathNoTCException as cancelled:
            raise none from cancelled
    obj.Label, obj.Base = label, [(thing, tuple(names)) for thing, names in faces]
    if controller is not None:
        obj.ToolController = controller
    if fit:
        choose_lead_and_cone(obj, job)
    add_view("surface_finish", obj)
    return obj


def _place(obj: Any) -> Place:
    return Place(document_name(obj.Document), obj.Label)


def _set_results(obj: Any, covered: Sequence[SurfacePoses], settings: SurfaceOptions) -> None:
    obj.PassCount = sum(int(poses.path.number.max()) + 1 for poses in covered)
    obj.ClampedAxes = sum(int(poses.clamped.sum()) for poses in covered)
    obj.UsedConeLimit = math.degrees(settings.rule.cone)
    obj.MaximumGouge = obj.UnseenGouge = obj.MaximumExcess = -1.0
    obj.GougePoint = obj.ExcessPoint = App.Vector()


def _measured(obj: Any, program: Program, cutter: Cutter, faces: Sequence[NamedFace], job: Any) -> Checked | None:
    """Measure gouges and excess, if enabled."""
    spacing = obj.CheckSpacing.Value
    if not spacing > 0.0:
        return None
    every, _ = model_faces(job.Model, (), _place(obj))
    names = {named.name for named in faces}
    others = [named.face for named in every or () if named.name not in names]
    with Progress(App.Qt.translate("Progress", "{}: gouges").format(obj.Label), _STEPS) as bar:
        return check_faces(
            program, cutter, [named.face for named in faces], others, bool(obj.FlipNormals), spacing,
            obj.ChordTolerance.Value, _MAX_EXCESS, _steps(bar),
        )  # fmt: skip


def _judge(obj: Any, checked: Checked | None) -> None:
    """Fill in the measurement; a gouge is a fault."""
    if checked is None:
        return
    obj.MaximumGouge, obj.GougePoint = checked.gouge, App.Vector(*checked.gouge_point)
    obj.UnseenGouge = checked.unseen
    obj.MaximumExcess, obj.ExcessPoint = checked.excess, App.Vector(*checked.excess_point)
    if checked.gouge > _GOUGE_FACTOR * obj.ChordTolerance.Value:
        depth, *point = (Amount(value, "mm", "z.3f") for value in (checked.gouge, *checked.gouge_point.tolist()))
        raise Refused([Diagnostic("N311", _place(obj), Phrase("{} at X {}, Y {}, Z {}", depth, *point))])


def _poses_over(
    faces: Sequence[NamedFace], cutter: Cutter, settings: SurfaceOptions, flipped: bool, place: Place
) -> list[SurfacePoses]:
    """The poses over all faces, in sequence."""
    covered: list[SurfacePoses] = []
    with Progress(place.operation, _STEPS * len(faces)) as bar:
        for named in faces:
            result = surface_poses(face_surface(named.face, flipped), cutter, settings, place, _steps(bar))
            covered.append(value_of(result, f"{named.name}: "))
    return covered


def _steps(bar: Progress) -> Callable[[float], None]:
    """Return a callback that advances the bar to a share of its steps; it raises when the user cancels."""
    reached = 0

    def progress(share: float) -> None:
        nonlocal reached
        while reached < int(share * _STEPS):
            reached += 1
            bar.step()

    return progress
