# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program object: a part program, G-code or CL data, as an object of a FreeCAD document.

Takes the path of a file by the property ``File``; sets the ``Path`` of the tool tip, with cutter compensation applied,
and the diagnostics in the property ``Found``. The file remains the program of record: it is read at every recompute
of the object. ``decode`` converts it to an operation of a CAM job. Saved documents store the class as
``pkm_post.freecad_app.program_object``: its module, its name and the names of its properties are a file format.
"""

from __future__ import annotations

from argparse import ArgumentTypeError
from pathlib import Path as FilePath
from typing import Any

import FreeCAD as App
import numpy as np
import Path
import Path.Op.Custom

from pkm_post.freecad_app.commands import commands_of
from pkm_post.freecad_app.document import members
from pkm_post.freecad_app.document_object import PropertyProxy, Row, print_diagnostics
from pkm_post.freecad_app.tools import preselected
from pkm_post.freecad_app.window import add_view
from pkm_post.model import Diagnostic, Diagnostics, EventKind, Phrase, Place, Program, Refused, required
from pkm_post.options import MOST_FEED, above_zero, cycle_kinds, format_value, goto_values, origin
from pkm_post.reading import (
    AXIS_WORDS,
    CONTOUR_DATA,
    DIALECTS,
    DWELL_UNITS,
    FLAVOUR_NAMES,
    SUFFIXES,
    UNITS,
    ReadingOptions,
    is_part_program,
    program_stem,
    read_part_program,
)
from pkm_post.toolpath import OffsetOptions, compensate

QT_TRANSLATE_NOOP = App.Qt.QT_TRANSLATE_NOOP


FROM_FILE = "file"
"""The choice that defers to the file."""
CYCLE_ORDERS = ("depth,feed,clearance", "depth,feed,clearance,step", "depth,feed")
"""The usual meanings of cycle parameters; the command line accepts others."""

_TYPED = {"Origins": origin, "FirstFeed": above_zero(MOST_FEED), "GotoValues": goto_values,
          "CycleKinds": cycle_kinds}  # fmt: skip
"""Properties typed like arguments."""
_DWELL_CHOICES = [FROM_FILE, *DWELL_UNITS]
_G = "Program"
_PROPERTIES: tuple[Row, ...] = (
    ("App::PropertyFile", "File", _G, QT_TRANSLATE_NOOP("App::Property", "The part program, G-code or CL data"), ""),
    ("App::PropertyEnumeration", "AxisWords", _G,
     QT_TRANSLATE_NOOP("App::Property", "Notation of the tool axis in G-code"), list(AXIS_WORDS)),
    ("App::PropertyEnumeration", "Flavour", _G,
     QT_TRANSLATE_NOOP("App::Property", "Dialect of the G-code"), [FROM_FILE, *FLAVOUR_NAMES]),
    ("App::PropertyEnumeration", "DwellUnit", _G,
     QT_TRANSLATE_NOOP("App::Property", "The unit of dwells of G-code"), _DWELL_CHOICES),
    ("App::PropertyFloatList", "MachineZero", _G,
     QT_TRANSLATE_NOOP("App::Property", "Position of the tool tip in mm at G53 X0 Y0 Z0, G28 and G30"), []),
    ("App::PropertyStringList", "LeaveOut", _G,
     QT_TRANSLATE_NOOP("App::Property", "Unknown codes of G-code to skip, such as M21"), []),
    ("App::PropertyStringList", "Origins", _G,
     QT_TRANSLATE_NOOP("App::Property", "Origins of work offsets of G-code, as in G55=100,0,0 with mm and degrees"),
     []),
    ("App::PropertyStringList", "Subprograms", _G,
     QT_TRANSLATE_NOOP("App::Property", "Folders searched for subprogram files before that of the part program"), []),
    ("App::PropertyBool", "BlockDelete", _G,
     QT_TRANSLATE_NOOP("App::Property", "Skip what follows a / in blocks of G-code"), False),
    ("App::PropertyIntegerList", "DeleteSwitches", _G,
     QT_TRANSLATE_NOOP("App::Property", "Switches of block delete that are on, as 2 for /2; none: as BlockDelete"), []),
    ("App::PropertyFloat", "FirstFeed", _G,
     QT_TRANSLATE_NOOP("App::Property", "Feed of cutting moves before the first one of the file, mm/min; 0 for none"),
     0.0),
    ("App::PropertyString", "GotoValues", _G,
     QT_TRANSLATE_NOOP("App::Property", "Meanings of the values of GOTO statements of CL data, as in x,y,z,i,j,k"), ""),
    ("App::PropertyString", "ToolTable", _G,
     QT_TRANSLATE_NOOP("App::Property", "File with the tools of the part program, as in tools.tbl,mm"), ""),
    ("App::PropertyString", "CycleKinds", _G,
     QT_TRANSLATE_NOOP("App::Property", "Strokes of kinds of CYCLE statements of CL data, as in BORE=ream,DEEPHL=deep"),
     ""),
    ("App::PropertyEnumeration", "Unit", _G,
     QT_TRANSLATE_NOOP("App::Property", "Unit of length of the part program"), [FROM_FILE, *UNITS]),
    ("App::PropertyEnumeration", "ContourData", _G,
     QT_TRANSLATE_NOOP("App::Property", "Meaning of the points of CL data under CUTCOM: tool centre or part contour"),
     [FROM_FILE, *CONTOUR_DATA]),
    ("App::PropertyEnumeration", "ClDialect", _G,
     QT_TRANSLATE_NOOP("App::Property", "The CAM system that wrote the CL data"), [FROM_FILE, *DIALECTS]),
    ("App::PropertyEnumeration", "CycleValues", _G,
     QT_TRANSLATE_NOOP("App::Property", "Meanings of the numbers without words in a CYCLE statement"),
     [FROM_FILE, *CYCLE_ORDERS]),
    ("App::PropertyBool", "OpenEnd", _G,
     QT_TRANSLATE_NOOP("App::Property", "Whether the part program may have no end, such as M2 or FINI"), False),
)  # fmt: skip
_RESULTS: tuple[Row, ...] = (
    ("App::PropertyStringList", "Found", _G,
     QT_TRANSLATE_NOOP("App::Property", "Diagnostics from reading the file"), []),
)  # fmt: skip


class PartProgram(PropertyProxy):
    """A part program. CAM draws its path; it is posted from its file, or from a job into which it is decoded."""

    properties = _PROPERTIES
    results = _RESULTS

    def onDocumentRestored(self, obj: Any) -> None:
        """Add the properties and choices that documents of older versions lack."""
        super().onDocumentRestored(obj)
        if FROM_FILE not in obj.getEnumerationsOfProperty("DwellUnit"):
            chosen = obj.DwellUnit
            obj.DwellUnit = _DWELL_CHOICES
            obj.DwellUnit = chosen

    def execute(self, obj: Any) -> None:
        """Read the file: FreeCAD calls this when a property has changed. A faulty file gives only its faults."""
        obj.Path = Path.Path()
        program, diagnostics = read_program(obj)
        obj.Found = [str(each) for each in diagnostics]
        print_diagnostics(diagnostics)
        if program is not None:
            obj.Path = Path.Path(commands_of(program))


_WITHOUT_PROPERTY = {"tools", "wear", "lengths", "machine_offsets", "functions", "spindle_axis", "shanks", "cores"}


def create_program(document: Any, file: str | FilePath, **reading: Any) -> Any:
    """Add a part program to a document.

    Args:
        document: target; it is recomputed, and the diagnostics of the file appear in the report view.
        file: G-code or CL data.
        reading: entries of ``ReadingOptions`` that have a property.

    Raises:
        TypeError: an entry has none, or ``ReadingOptions`` has no such entry.
    """
    if lost := sorted(_WITHOUT_PROPERTY & set(reading)):
        raise TypeError(f"create_program: a part program has no property for {', '.join(lost)}")
    options = ReadingOptions(**reading)
    path = FilePath(file).absolute()
    obj = document.addObject("Path::FeaturePython", "PkmProgram")
    PartProgram(obj)
    obj.File, obj.Label = str(path), path.name
    set_reading(obj, options)
    add_view("program", obj)
    document.recompute()
    return obj


def reading_of(obj: Any) -> ReadingOptions:
    """The reading options in the properties of a program object."""
    choices = (obj.Unit, obj.ContourData, obj.ClDialect, obj.CycleValues, obj.Flavour, obj.DwellUnit)
    unit, contour_data, dialect, values, flavour, dwell_unit = (
        None if choice == FROM_FILE else choice for choice in choices
    )
    x_y_z = tuple(obj.MachineZero)
    return ReadingOptions(
        obj.AxisWords,
        dwell_unit=dwell_unit,
        unit=unit,
        contour_data=contour_data,
        cl_dialect=dialect,
        cycle_values=tuple(values.split(",")) if values else (),
        allow_open_end=obj.OpenEnd,
        flavour=flavour,
        machine_zero=x_y_z if len(x_y_z) == len("XYZ") else None,
        left_out=tuple(code.upper() for code in obj.LeaveOut),
        work_offsets=dict(_typed(obj, "Origins")),
        subprograms=tuple(obj.Subprograms),
        block_delete=obj.BlockDelete,
        delete_switches=tuple(obj.DeleteSwitches),
        feed=next((feed / 60 for feed in _typed(obj, "FirstFeed")), None),
        goto_values=next(iter(_typed(obj, "GotoValues")), ()),
        tool_table=obj.ToolTable or None,
        cycle_kinds=dict(next(iter(_typed(obj, "CycleKinds")), ())),
    )


def _texts(obj: Any, name: str) -> list[str]:
    """The texts of a property; none if it is empty."""
    value = getattr(obj, name)
    return [str(each) for each in (value if isinstance(value, list) else [value]) if each]


def _typed(obj: Any, name: str) -> list[Any]:
    """The valid values of a property typed like an argument; ``_wrong`` reports the others."""
    return [value for text in _texts(obj, name) if (value := _converted(name, text)[0]) is not None]


def _converted(name: str, text: str) -> tuple[Any, str]:
    """A value, or None and the fault of its text."""
    try:
        return _TYPED[name](text), ""
    except ArgumentTypeError as fault:
        return None, str(fault)


def _wrong(obj: Any) -> Diagnostics:
    """Faults of properties with invalid text."""
    found = [
        f"{name}: {wrong}" for name in _TYPED for text in _texts(obj, name) if (wrong := _converted(name, text)[1])
    ]
    if len(obj.MachineZero) not in (0, len("XYZ")):
        found.append(Phrase("MachineZero: expected X, Y and Z or nothing, got {}", list(obj.MachineZero)))
    return tuple(Diagnostic("J121", Place(str(obj.File), obj.Label), text) for text in found)


def set_reading(obj: Any, reading: ReadingOptions) -> None:
    """Store reading options in the properties of a program object; wear and cutters have none."""
    choices: dict[str, str | bool | float | list[Any]] = {
        "AxisWords": reading.axis_words,
        "Flavour": reading.flavour or FROM_FILE,
        "DwellUnit": reading.dwell_unit or FROM_FILE,
        "MachineZero": list(reading.machine_zero or ()),
        "LeaveOut": list(reading.left_out),
        "Origins": [format_value("origin", each) for each in reading.work_offsets.items()],
        "Subprograms": list(reading.subprograms),
        "BlockDelete": reading.block_delete,
        "DeleteSwitches": list(reading.delete_switches),
        "FirstFeed": float(f"{60 * (reading.feed or 0.0):.12g}"),
        "GotoValues": ",".join(reading.goto_values),
        "ToolTable": reading.tool_table or "",
        "CycleKinds": ",".join(map("=".join, reading.cycle_kinds.items())),
        "Unit": reading.unit or FROM_FILE,
        "ContourData": reading.contour_data or FROM_FILE,
        "ClDialect": reading.cl_dialect or FROM_FILE,
        "CycleValues": ",".join(reading.cycle_values) or FROM_FILE,
        "OpenEnd": reading.allow_open_end,
    }
    for name, choice in choices.items():
        if getattr(obj, name) != choice:
            setattr(obj, name, choice)


def read_program(obj: Any) -> tuple[Program | None, Diagnostics]:
    """The program of an object with cutter compensation applied, or None, and the diagnostics."""
    file = FilePath(obj.File)
    if not is_part_program(file):
        return None, (Diagnostic("F103", Place(str(file)), f"its name ends with none of {', '.join(SUFFIXES)}"),)
    wrong = _wrong(obj)
    if wrong:
        return None, wrong
    program, diagnostics = read_part_program(file, reading_of(obj))
    if program is None:
        return None, diagnostics
    compensated, faults = compensate(program, OffsetOptions(), {})
    return compensated, (*diagnostics, *faults)


def decode(obj: Any, job: Any) -> Any:
    """Convert a part program to an operation of a CAM job.

    The operation holds the current commands and does not follow the file. Its tool controller is the one with the
    number of the first tool of the program.

    Args:
        job: the job, which gets a Custom operation.

    Raises:
        Refused: the program is faulty, or the job lacks its tool; the job is unchanged.
    """
    program = required(*read_program(obj))
    controller = _first_controller(program, job)
    commands = commands_of(program)
    first = next((index for index, each in enumerate(commands) if each.Name == "M6"), None)
    if first is not None:  # the job already calls the tool of the controller
        del commands[first]
    print_diagnostics(_left_out(program))
    with preselected(controller):
        operation = Path.Op.Custom.Create("Decoded", parentJob=job)
    operation.Label = program_stem(FilePath(obj.File))
    operation.ToolController = controller
    operation.Gcode = [command.toGCode() for command in commands]
    job.Document.recompute()
    return operation


def _first_controller(program: Program, job: Any) -> Any:
    """The tool controller of the first tool that a program calls; the job's first one if it calls none."""
    called = next((event.value for event in program.events if event.kind is EventKind.TOOL_CHANGE), None)
    fitting = [each for each in members(job.Tools) if called in (None, each.ToolNumber)]
    if not fitting:
        known = ", ".join(f"T{each.ToolNumber}" for each in members(job.Tools))
        found = f"the program calls T{called:g}, {job.Label} has {known or 'no tools'}"
        raise Refused([Diagnostic("J112", Place(program.source), found)])
    return fitting[0]


def _left_out(program: Program) -> Diagnostics:
    """Warnings for data that CAM commands cannot express."""
    rows = {
        "surface normals": np.isfinite(program.normal).all(axis=1),
        "turns of the platform": np.isfinite(program.spin),
    }
    counts = {name: int(np.count_nonzero(column)) for name, column in rows.items()}
    return tuple(
        Diagnostic("J120", Place(program.source), Phrase("{} of {} moves", name, count))
        for name, count in counts.items()
        if count
    )
