# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tapered column of the paper: elliptic at the foot, circular at the top, finished on five axes.

Sizes enter; a FreeCAD document with the column, a CAM job and four operations leaves. Only the first quadrant is
computed: contact points and normals of the wall, tool axes, compensated tool tips. The other three are that one
mirrored in the x-z plane, mirrored in the y-z plane, and turned by 180 degrees. The origin of the work frame is the
centre of the foot. Units: mm, rad, mm/s. [paper section 6]
"""

from __future__ import annotations

import dataclasses
import math
import sys
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import FreeCAD as App
import numpy as np
import Part
import Path.Main.Job
import Path.Op.Custom
import Path.Preferences

import pkm_post as pkm

Array = np.ndarray[Any, np.dtype[np.float64]]

POST_PROCESSOR = "hexapod_pmac"
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Column:
    """The part, the tool and the way the wall is cut.

    Attributes:
        foot_semi_axes: of the ellipse at z = 0, along x and along y.
        top_radius: of the circle at z = height.
        height: of the column.
        lowest_contact: height to which the wall is cut, so that the bottom of the leaning cutter clears the table.
        stepover: largest distance of two passes along the wall.
        spacing: largest distance of two contact points of a pass.
        relief: angle from the generator of the wall out to the tool axis.
        lead: angle by which the tool axis leans in the direction of travel, in the middle of a pass.
        tool: the cutter. A bull nose: it is the general case of the compensation, where the tip depends on normal and
            axis in every term, and at this relief the wall touches the middle of its corner.
        feed: of the tool tip.
        spindle_speed: in revolutions per minute.
        standoff: distance from the wall where the feed begins and ends.
        clearance: height above the column for rapid moves.
        allowance: how far the wall of the stock is outside of the column: it was roughed before.
    """

    foot_semi_axes: tuple[float, float] = (60.0, 40.0)
    top_radius: float = 25.0
    height: float = 80.0
    lowest_contact: float = 8.0
    stepover: float = 2.5
    spacing: float = 0.4
    relief: float = math.radians(31.0)
    lead: float = math.radians(8.0)
    tool: pkm.Tool = pkm.Tool(number=1, name="Bull nose D16 r4", diameter=16.0, corner_radius=4.0, length=120.0)
    feed: float = 30.0
    spindle_speed: float = 12000.0
    standoff: float = 5.0
    clearance: float = 20.0
    allowance: float = 0.5

    def __post_init__(self) -> None:
        along_x, along_y = self.foot_semi_axes
        if not along_x >= along_y >= self.top_radius > 0.0:
            got = f"{along_x}, {along_y}, {self.top_radius}"
            raise ValueError(f"Column: expected foot semi-axes x >= y >= top radius > 0, got {got}")
        if not 0.0 <= self.lowest_contact < self.height:
            raise ValueError(f"Column: expected 0 <= lowest contact < {self.height}, got {self.lowest_contact}")


@dataclass(frozen=True)
class Contacts:
    """Where the cutter touches the wall, in the order of travel.

    Attributes:
        point: (N, 3) contact points.
        normal: (N, 3) outward unit normals there.
        lead: (N,) lean of the tool axis towards rising angle about z.
    """

    point: Array
    normal: Array
    lead: Array


def solid(column: Column) -> Part.Shape:
    """The column as a solid, its wall one ruled face: u is the angle from the x-axis, v rises from 0 to 1."""
    foot = Part.Ellipse(App.Vector(), *column.foot_semi_axes)
    top = Part.Circle(App.Vector(0.0, 0.0, column.height), App.Vector(0.0, 0.0, 1.0), column.top_radius)
    make_solid, make_ruled = True, True
    return Part.makeLoft([Part.Wire(foot.toShape()), Part.Wire(top.toShape())], make_solid, make_ruled)


def roughed(document: App.Document, column: Column) -> App.DocumentObject:
    """The stock: the column with an allowance on its wall."""
    foot = tuple(axis + column.allowance for axis in column.foot_semi_axes)
    larger = dataclasses.replace(column, foot_semi_axes=foot, top_radius=column.top_radius + column.allowance)
    stock = document.addObject("Part::Feature", "Stock")
    stock.Label, stock.Shape = "Roughed column", solid(larger)
    return stock


def wall(shape: Part.Shape) -> Part.Face:
    """The face of the column that is not flat."""
    return next(face for face in shape.Faces if face.Surface.TypeId != "Part::GeomPlane")


def contacts(column: Column) -> Contacts:
    """Contact points of the quadrant x >= 0, y >= 0: level by level from the top, to and fro.

    The lead fades out towards both ends of a pass. There the tool axis lies in a plane of symmetry of the column, so
    that it does not jump where the direction of travel turns, and the mirrored quadrants meet in the same poses.
    """
    face = wall(solid(column))
    drop = column.height - column.lowest_contact
    flattest = (column.foot_semi_axes[0] - column.top_radius) / column.height
    levels = math.ceil(drop * math.hypot(1.0, flattest) / column.stepover) + 1
    passes = []
    for number, v in enumerate(np.linspace(1.0, column.lowest_contact / column.height, levels)):
        u, fraction = _even_steps(face, v, column.spacing)
        direction = 1 if number % 2 == 0 else -1
        point, normal = pkm.surface_points(face, u, np.full(len(u), v))
        lead = direction * column.lead * np.sin(np.pi * fraction)
        passes.append((point[::direction], normal[::direction], lead[::direction]))
    return Contacts(*(np.concatenate(columns) for columns in zip(*passes, strict=True)))


def _even_steps(face: Part.Face, v: float, spacing: float) -> tuple[Array, Array]:
    """Parameters u of a quarter turn at equal steps of arc length, and the fraction of the way there."""
    dense_u = np.linspace(0.0, math.pi / 2, 361)
    points, _ = pkm.surface_points(face, dense_u, np.full(len(dense_u), v))
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    fraction = np.linspace(0.0, 1.0, math.ceil(way[-1] / spacing) + 1)
    return np.interp(fraction * way[-1], way, dense_u), fraction


def tool_axes(normals: Array, relief: float, lead: Array) -> Array:
    """Tool axes that lean off the wall by the relief and along it by the lead, (N, 3).

    An upright tool would touch the wall with its corner as well, as the wall falls back towards the top; leaning out
    keeps the same spot of the corner in touch all the way round, and turns the shank further away from the wall.
    """
    outward = normals * [1.0, 1.0, 0.0] / np.hypot(normals[:, 0], normals[:, 1])[:, None]
    along = np.cross(UP, outward)
    tilt = (relief - np.arcsin(normals[:, 2]))[:, None]
    lead = lead[:, None]
    return np.cos(lead) * (np.cos(tilt) * UP + np.sin(tilt) * outward) + np.sin(lead) * along


def tool_path(column: Column, touched: Contacts) -> tuple[Array, Array]:
    """Tool tips and unit tool axes that touch the wall, (N, 3) each."""
    axis = tool_axes(touched.normal, column.relief, touched.lead)
    tip, faults = pkm.tip_from_contact(touched.point, touched.normal, axis, pkm.Cutter.of(column.tool))
    if tip is None:
        raise ValueError("\n".join(str(fault) for fault in faults))
    return tip, axis


def quadrant(column: Column) -> list[str]:
    """The G-code of the first quadrant, F in mm/s as CAM operations have it."""
    touched = contacts(column)
    tip, axis = tool_path(column, touched)
    begin, end = (tip[row] + column.standoff * touched.normal[row] for row in (0, -1))
    above = column.height + column.clearance
    return [
        _line("G0", [*begin[:2], above], axis[0]),
        _line("G0", begin, axis[0]),
        *(_line("G1", *pose, column.feed) for pose in zip(tip, axis, strict=True)),
        _line("G1", end, axis[-1], column.feed),
        _line("G0", [*end[:2], above], axis[-1]),
    ]


def _line(code: str, tip: Any, axis: Any, feed: float | None = None) -> str:
    """One block, in fixed point: FreeCAD does not read exponents."""
    numbers = dict(zip("XYZIJK", [*tip, *axis], strict=True)) | ({} if feed is None else {"F": feed})
    return " ".join([code, *(f"{letter}{round(number, 6) + 0.0:.6f}" for letter, number in numbers.items())])


def bull_nose(document: App.Document, tool: pkm.Tool) -> App.DocumentObject:
    """A stock tool bit with the sizes of the tool; FreeCAD 1.0 gives the flat radius where 1.1 gives the corner."""
    sizes = {"Diameter": tool.diameter, "ShankDiameter": tool.diameter, "CuttingEdgeHeight": 40.0, "Length": 110.0}
    flat = {"FlatRadius": tool.diameter / 2 - tool.corner_radius}
    corner = {"CornerRadius": tool.corner_radius}
    bit = {"name": tool.name, "shape": "bullnose.fcstd", "attribute": {}}
    try:
        from Path.Tool.toolbit import ToolBit
    except ImportError:
        from Path.Tool.Bit import Factory

        return Factory.CreateFromAttrs(bit | {"parameter": _millimetres(sizes | flat)}, tool.name)
    return ToolBit.from_dict(bit | {"parameter": _millimetres(sizes | corner)}).attach_to_doc(doc=document)


def _millimetres(sizes: dict[str, float]) -> dict[str, str]:
    return {name: f"{size:.4f} mm" for name, size in sizes.items()}


def controller(job: App.DocumentObject, column: Column) -> App.DocumentObject:
    """The tool controller of the job, with the column's tool in place of the stock one."""
    tool_controller = job.Tools.Group[0]
    stock_bit = tool_controller.Tool
    tool_controller.Tool = bull_nose(job.Document, column.tool)
    stock_bit.Proxy.onDelete(stock_bit)
    tool_controller.Label = f"TC: {column.tool.name}"
    tool_controller.ToolNumber = column.tool.number
    tool_controller.HorizFeed = tool_controller.VertFeed = f"{column.feed} mm/s"
    tool_controller.SpindleSpeed = column.spindle_speed
    tool_controller.SpindleDir = "Forward"
    pkm.set_gauge_length(tool_controller, column.tool.length)
    return tool_controller


def build(
    column: Column = Column(),  # noqa: B008 - frozen
    out: FilePath | None = None,
) -> tuple[App.Document, App.DocumentObject]:
    """Make the document: part, job, one quadrant and its three copies.

    Args:
        column: sizes of the part and of the cut.
        out: folder to save ``tapered_column.FCStd`` in; nothing is saved without one.

    Returns:
        The document and its job.
    """
    document = App.newDocument("tapered_column")
    part = document.addObject("Part::Feature", "Column")
    part.Shape = solid(column)
    job = Path.Main.Job.Create("Job", [part], None)
    if POST_PROCESSOR in Path.Preferences.allAvailablePostProcessors():
        job.PostProcessor = POST_PROCESSOR
    box, job.Stock = job.Stock, roughed(document, column)
    document.removeObject(box.Name)
    tool_controller = controller(job, column)
    first = Path.Op.Custom.Create("Quadrant_1", parentJob=job)
    first.Label = "Quadrant 1"
    first.ToolController = tool_controller
    first.Gcode = quadrant(column)
    document.recompute()
    pkm.mirror(first, (0.0, 1.0, 0.0), label="Quadrant 4")
    pkm.mirror(first, (1.0, 0.0, 0.0), label="Quadrant 2")
    pkm.rotate(first, (0.0, 0.0, 1.0), math.pi, label="Quadrant 3")
    document.recompute()
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
        document.saveAs(str(out / "tapered_column.FCStd"))
    return document, job


if __name__ == "__main__":
    build(out=FilePath(sys.argv[1]))
