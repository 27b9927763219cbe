# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options: the user's choices for a program, in mm and rad."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import ZERO_TORSION, SpinPolicy
from pkm_post.model import EMPTY_SETUP, Setup, Tolerances, Tool, read_only
from pkm_post.system import result_files
from pkm_post.toolpath import OPTIONAL_STOPS, Copies, OffsetOptions

if TYPE_CHECKING:
    from pkm_post.toolpath import StartLine, SurfaceSpeed

CARTESIAN = "cartesian"
"""The side output of a program in X Y Z A B C."""
LINUXCNC = "linuxcnc"
"""The name in ``Options.also`` of a program for LinuxCNC's hexapod, which is not a table of the motion."""

PICTURE = "picture"
"""The name in ``Options.also`` of the report as a picture."""

NO_MESH = "none"
"""In place of a file: no mesh, even if the job has one."""


@dataclass(frozen=True)
class MeshFiles:
    """Files with meshes of the set-up; they, or ``NO_MESH``, replace the meshes of the job.

    Attributes:
        part: mesh of the finished part; None to use that of the job.
        stock: mesh of the stock before the first operation; None to use that of the job.
    """

    part: str | None = None
    stock: str | None = None
    fixtures: tuple[str, ...] = ()


@dataclass(frozen=True)
class Options:
    """The user's choices.

    Attributes:
        work_offset: name of a work offset in the machine file, or the (4, 4) pose of {C} in {M}.
        tip_tolerance: largest deviation of the tool tip from the programmed path, mm.
        axis_tolerance: largest deviation of the tool axis from the programmed one, rad.
        spin: rule for the rotation of the platform about the tool axis.
        contours: options of 2D cutter compensation (G41, G42, CUTCOM).
        actual_tools: by number, tools whose cutters differ from those the program was made for; a program with
            surface normals is compensated for them.
        copies: mirror images and rotations that follow the program.
        optional_stops: treatment of optional stops, one of ``toolpath.OPTIONAL_STOPS``; None for that of the machine
            file.
        surface_speed: cutting speed to keep; None leaves the spindle as programmed.
        side: number of the side to post, from 1, where a part is turned over; None for the whole program.
        from_line: line to start from; None for the whole program.
        also: side outputs, keys of ``system.result_files.SIDE_OUTPUTS``.
        report_unit: unit of lengths on the page of the report, mm or inch; all other files are in mm.
        report_date: text on the page of the report, such as a date; empty for none.
        mesh_files: mesh files of the bodies in the collision check.
        setup: the set-up known without files, as from a CAM job.

    Raises:
        TypeError: a value is of another type.
        ValueError: a tolerance is out of range, the work offset is no pose, or a name is unknown.
    """

    work_offset: str | Array = "G54"
    tip_tolerance: float = 1e-3
    axis_tolerance: float = math.radians(1e-3)
    spin: SpinPolicy = ZERO_TORSION
    contours: OffsetOptions = OffsetOptions()
    actual_tools: Mapping[int, Tool] = field(default_factory=dict)
    copies: Copies = Copies()
    surface_speed: SurfaceSpeed | None = None
    optional_stops: str | None = None
    side: int | None = None
    from_line: StartLine | None = None
    also: tuple[str, ...] = ()
    report_unit: str = "mm"
    report_date: str = ""
    mesh_files: MeshFiles = MeshFiles()
    setup: Setup = EMPTY_SETUP

    def __post_init__(self) -> None:
        for name, kind in _KINDS.items():
            value = getattr(self, name)
            if not isinstance(value, kind):
                raise TypeError(f"{name}: expected {kind.__name__}, got {type(value).__name__} {value!r:.60}")
        for name, (least, most, unit) in _RANGES.items():
            value = getattr(self, name)
            if not isinstance(value, int | float | np.number) or not least <= value <= most:
                raise ValueError(f"{name}: expected {least:g} to {most:.4g} {unit}, got {value!r}")
            object.__setattr__(self, name, float(value))  # a NumPy number has no place in a report
        for name, known in _NAMES.items():
            if getattr(self, name) not in known:
                raise ValueError(f"{name}: expected one of {', '.join(map(str, known))}, got {getattr(self, name)!r}")
        outputs = result_files.SIDE_OUTPUTS
        if not set(self.also) <= set(outputs):
            raise ValueError(f"also: expected names out of {', '.join(outputs)}, got {', '.join(self.also)}")
        if self.side is not None and (not isinstance(self.side, int) or self.side < 1):
            raise ValueError(f"side: expected a whole number from 1, got {self.side!r}")
        self._require_parts()
        if not isinstance(self.work_offset, str):
            if not _is_pose(self.work_offset):
                raise ValueError(f"work_offset: expected a name or a (4, 4) pose, in mm, got {self.work_offset!r:.60}")
            object.__setattr__(self, "work_offset", read_only(np.array(self.work_offset, dtype=np.float64)))

    def _require_parts(self) -> None:
        """Check the values whose classes are imported where they are used."""
        if any(not isinstance(tool, Tool) for tool in self.actual_tools.values()):
            raise TypeError("actual_tools: expected a Tool for each number")
        if self.surface_speed is not None or self.from_line is not None:
            from pkm_post.toolpath import StartLine, SurfaceSpeed

            for name, kind in (("surface_speed", SurfaceSpeed), ("from_line", StartLine)):
                if not isinstance(value := getattr(self, name), kind | None):
                    raise TypeError(f"{name}: expected {kind.__name__}, got {type(value).__name__} {value!r:.60}")

    @property
    def tolerances(self) -> Tolerances:
        """Both tolerances."""
        return Tolerances(self.tip_tolerance, self.axis_tolerance)


_KINDS: dict[str, type] = {
    "spin": SpinPolicy, "contours": OffsetOptions, "actual_tools": Mapping, "copies": Copies, "also": tuple,
    "report_date": str, "mesh_files": MeshFiles, "setup": Setup,
}  # fmt: skip
_RANGES = {"tip_tolerance": (1e-9, 100.0, "mm"), "axis_tolerance": (1e-9, math.pi / 4, "rad")}
_NAMES = {"optional_stops": (None, *OPTIONAL_STOPS), "report_unit": ("mm", "inch")}


def _is_pose(value: Any) -> bool:
    """Whether a value is a rotation and a shift, as in a machine file."""
    try:
        pose = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        return False
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        return False
    turn = pose[:3, :3]
    same = np.allclose(turn @ turn.T, np.eye(3), atol=1e-6) and np.array_equal(pose[3], [0.0, 0.0, 0.0, 1.0])
    return bool(same and np.linalg.det(turn) > 0)
