# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job: combines the active operations of a CAM job, in tree order, into one program.

Takes a job of FreeCAD's CAM workbench, or a selection of its operations and fixtures; returns a program in mm, rad and
mm/s, or all faults of the job. An operation is read once for each fixture, in CAM's order. The list of operations is
built here: the one FreeCAD 1.0 builds may lose operations.
What CAM stores outside the paths becomes events: tool, spindle and coolant, each where it changes, and off at the end
and at tool changes. FreeCAD newer than 1.1 offers selections in CAM's Post Process dialog.
"""

from __future__ import annotations

import contextlib
import dataclasses
import gc
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from Path.Base.Util import opProperty, toolControllerForOp

from pkm_post.freecad_app.commands import read_commands
from pkm_post.freecad_app.document import document_name, members
from pkm_post.freecad_app.document_checks import (
    change_faults,
    failed_input,
    feed_faults,
    file_faults,
    has_inactive_base,
    left_out_faults,
    state_faults,
)
from pkm_post.freecad_app.fixtures import DEFAULT, ONE_PLACE, cutting_order, files_of_split_output, operation_name
from pkm_post.freecad_app.frames import matrix_of
from pkm_post.freecad_app.tools import SPINDLE_SENSES, read_tools
from pkm_post.geometry import Array
from pkm_post.model import (
    PROGRAM_COLUMNS,
    Diagnostic,
    Diagnostics,
    Event,
    EventKind,
    Kind,
    Phrase,
    Place,
    Program,
    Tool,
    errors,
)
from pkm_post.reading import without_idle_starts
from pkm_post.toolpath import transform


@dataclass(frozen=True)
class Selection:
    """The selected items; None for all.

    Attributes:
        operations: some of the job's own.
        fixtures: some of the job's own.
    """

    operations: Sequence[Any] | None = None
    fixtures: Sequence[str] | None = None

    def operations_of(self, job: Any) -> list[Any]:
        """The selected operations, in the order of the job."""
        own = members(job.Operations)
        return own if self.operations is None else [each for each in own if each in self.operations]

    def foreign_operations(self, job: Any) -> list[Any]:
        """Selected operations that do not belong to the job."""
        return [each for each in self.operations or () if each not in members(job.Operations)]

    def fixtures_of(self, job: Any) -> list[str]:
        """The selected fixtures, in the order of the job; at least one."""
        own = list(job.Fixtures)
        return [each for each in own if self.fixtures is None or each in self.fixtures] or [DEFAULT]


EVERYTHING = Selection()
"""The whole job."""
NO_LENGTHS: Mapping[int, float] = MappingProxyType({})
"""No gauge lengths: those of the tool controllers apply."""

_COOLANT = {"None": 0.0, "Flood": 1.0, "Mist": 2.0}
_IN_PLACE = np.eye(4)
_OFF = {EventKind.SPINDLE: 0.0, EventKind.COOLANT: 0.0}


def read_job(
    job: Any,
    tool_lengths: Mapping[int, float] = NO_LENGTHS,
    selection: Selection = EVERYTHING,
    places: Mapping[str, Array] = ONE_PLACE,
    spindle_axis: bool = False,
) -> tuple[Program | None, Diagnostics]:
    """Read the program of a CAM job.

    Args:
        job: the job, a document object, recomputed.
        tool_lengths: gauge lengths by tool number that override those of the tool controllers, mm.
        selection: the part of the job to read.
        places: (4, 4) pose in {C} of each of several fixtures, at which the operations are read in turn.
        spindle_axis: whether the spindle can be an axis; otherwise tapping is refused.

    Returns:
        The program, or None if there are errors; and all diagnostics.
    """
    builder = _ProgramBuilder(job, spindle_axis)
    faults = [*file_faults(job.Document), *_foreign(job, selection, Place(builder.source, job.Label))]
    active, fixtures = [each for each in selection.operations_of(job) if is_active(each)], selection.fixtures_of(job)
    for fixture, operation in cutting_order(active, fixtures, job.OrderOutputBy):
        name = operation_name(operation.Label, fixture, fixtures)
        pose = places.get(fixture, _IN_PLACE)
        found = state_faults(operation, builder.source) or builder.add(operation, pose, name, fixture)
        faults += [each for each in found if each not in faults]  # once, not per fixture
    files = files_of_split_output(active, fixtures, job.OrderOutputBy) if job.SplitOutput else 1
    if files > 1:
        split = Phrase("{} files by {}", files, job.OrderOutputBy)
        faults.append(Diagnostic("J140", Place(builder.source, job.Label), split))
    builder.switch(_OFF)
    tools, tool_faults = read_tools(builder.controllers.values(), tool_lengths, builder.source)
    faults += tool_faults
    shapes = [each for each in (*members(job.Model), job.Stock) if each is not None]
    failed = next(filter(None, map(failed_input, shapes)), "")
    if failed and not errors(faults):
        faults.append(Diagnostic("J116", Place(builder.source, job.Label), failed))
    if not builder.rows and not errors(faults):
        faults.append(Diagnostic("J103", Place(builder.source, job.Label), Phrase("nothing to post")))
    if errors(faults):
        return None, tuple(faults)
    summary = builder.summary(job, active, len(fixtures))
    return dataclasses.replace(builder.program(tools), reading=(summary,)), tuple(faults)


@contextlib.contextmanager
def _no_collections() -> Iterator[None]:
    """Suspend garbage collection: hundreds of thousands of commands arrive at once, none of them garbage."""
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()


def is_active(operation: Any) -> bool:
    """Whether an operation is part of the program."""
    return opProperty(operation, "Active") is not False


def _coolant(operation: Any) -> float:
    """The coolant of an operation, as the value of an event."""
    return _COOLANT[opProperty(operation, "CoolantMode") or "None"]


def _acts(program: Program) -> bool:
    """Whether a program cuts, or switches or waits for something."""
    return bool(program.events or np.any(program.kind != Kind.RAPID))


def _may_do_nothing(operation: Any) -> bool:
    """Whether an operation without cuts is meant: Custom is as typed, and a copy of an inactive operation is empty."""
    return hasattr(operation, "Gcode") or has_inactive_base(operation)


def _foreign(job: Any, selection: Selection, place: Place) -> list[Diagnostic]:
    """Selected operations that are missing."""
    return [Diagnostic("J127", place, each.Label) for each in selection.foreign_operations(job)]


class _ProgramBuilder:
    """The program under construction, with the machine state at its current end.

    Attributes:
        source: name of the document.
        rows: number of rows so far.
        controllers: the tool controllers in use, by the name of the object.
    """

    def __init__(self, job: Any, spindle_axis: bool) -> None:
        self.source = document_name(job.Document)
        self.rows = 0
        self.controllers: dict[str, Any] = {}
        self._in_job, self._stock, self._spindle_axis = members(job.Tools), job.Stock, spindle_axis
        self._programs: list[Program] = []
        self._events: list[Event] = []
        self._state: dict[EventKind, float] = dict(_OFF)
        self._tip = np.full(3, np.nan)
        self._typed: dict[EventKind, tuple[str, Any]] = {}
        self._reported: set[tuple[EventKind, str]] = set()
        self._compared: set[str] = set()

    def add(self, operation: Any, work_from_fixture: Array, name: str, fixture: str) -> list[Diagnostic]:
        """Append an operation at a fixture, with its placement applied to points and tool axes."""
        work_from_operation = work_from_fixture @ matrix_of(operation.Placement)
        start = np.linalg.solve(work_from_operation, [*self._tip, 1.0])[:3]
        with _no_collections():
            program, read_faults = read_commands(
                operation.Path.Commands, self.source, operation.Label, start, self._spindle_axis, fixture
            )
        faults = list(read_faults)
        if program is None:
            return faults
        controller = toolControllerForOp(operation)
        faults += feed_faults(operation, controller, program, start, self.source)
        faults += left_out_faults(operation, self.source)
        faults += change_faults(operation, self._stock, self.source, self._compared)
        program, placement_faults = transform(program, work_from_operation)
        if program is None:
            return [*faults, *placement_faults]
        if controller is not None and not (_acts(program) or _may_do_nothing(operation)):
            faults.append(Diagnostic("J141", Place(self.source, operation.Label), Phrase("only rapid moves")))
        if len(program) and controller is None:
            return [*faults, Diagnostic("J112", Place(self.source, operation.Label), Phrase("none is set"))]
        if len(program) or program.events:
            faults += self._start(operation, controller, program, name)
        if len(program):
            self._tip = program.position[-1]
        faults += self._append(dataclasses.replace(program, operations=(name,)))
        self._note_typed(operation, program)
        return faults

    def _note_typed(self, operation: Any, program: Program) -> None:
        """Note what an operation leaves switched: CAM's own posts keep it while the tool controller is the same.

        They also write M9 after an operation with a CoolantMode, and that of the next one after an M9.
        """
        kinds = {event.kind for event in program.events} & set(_OFF)
        if _coolant(operation) or not self._state[EventKind.COOLANT]:
            kinds.discard(EventKind.COOLANT)
        self._typed |= dict.fromkeys(kinds, (operation.Label, toolControllerForOp(operation)))

    def _undone(
        self, operation: Any, program: Program, wanted: Mapping[EventKind, float], name: str
    ) -> list[Diagnostic]:
        """What is switched back here, unless the operation switches it before its first cut, or changes controller.

        What an operation switches is reported once, not at each fixture.
        """
        typed, self._typed = self._typed, {}
        first_cut = next(iter(np.flatnonzero(program.kind != Kind.RAPID)), len(program))
        again = {event.kind for event in program.events if event.row <= first_cut}
        controllers = None, toolControllerForOp(operation)
        undone = {
            (kind, label): Diagnostic("J145", Place(self.source, label), Phrase("{}, until {}", self._code(kind), name))
            for kind, (label, controller) in typed.items()
            if kind not in again and controller in controllers and self._state[kind] != wanted[kind]
        }
        new = [fault for key, fault in undone.items() if key not in self._reported]
        self._reported |= set(undone)
        return new

    def _code(self, kind: EventKind) -> str:
        """The command that brought the present state."""
        value = self._state[kind]
        if kind is EventKind.COOLANT:
            return "M8" if value == 1 else "M7"
        return f"M{3 if value > 0 else 4} S{abs(value):g}" if value else "M5"

    def _start(self, operation: Any, controller: Any, program: Program, name: str) -> list[Diagnostic]:
        """Load the tool of an operation, with its spindle speed and coolant; CAM's Stop has none."""
        if controller is None:
            self.switch({} if EventKind.COOLANT in self._typed else {EventKind.COOLANT: 0.0})
            return []
        speed = SPINDLE_SENSES[controller.SpindleDir] * controller.SpindleSpeed
        wanted = {EventKind.SPINDLE: speed, EventKind.COOLANT: _coolant(operation)}
        faults = self._undone(operation, program, wanted, name)
        self.controllers[controller.Name] = controller
        if self._state.get(EventKind.TOOL_CHANGE) != controller.ToolNumber:
            self.switch(_OFF)
            self.switch({EventKind.TOOL_CHANGE: float(controller.ToolNumber)})
        self.switch(wanted)
        return faults

    def switch(self, wanted: Mapping[EventKind, float]) -> None:
        """Append events that bring the machine to the requested state."""
        for kind, value in wanted.items():
            if self._state.get(kind) != value:
                if kind is EventKind.COOLANT and value and self._state.get(kind):  # M7 leaves the flood of M8 on
                    self._append_event(Event(self.rows, kind, 0.0))
                self._append_event(Event(self.rows, kind, value))

    def _append_event(self, event: Event) -> None:
        self._events.append(event)
        self._state[event.kind] = event.value
        if event.kind is EventKind.TOOL_CHANGE:  # which leaves the spindle stopped
            self._state[EventKind.SPINDLE] = 0.0

    def _append(self, program: Program) -> list[Diagnostic]:
        """Append rows and events; an M6 among them may call a tool that the job does not have."""
        faults = []
        for event in program.events:
            self._append_event(dataclasses.replace(event, row=self.rows + event.row))
            if event.kind is EventKind.SPINDLE_AXIS and event.value == 0 and self._state[EventKind.SPINDLE]:
                self._append_event(Event(self.rows + event.row, EventKind.SPINDLE, self._state[EventKind.SPINDLE]))
            if event.kind is EventKind.TOOL_CHANGE:
                called = [controller for controller in self._in_job if controller.ToolNumber == event.value]
                self.controllers |= {controller.Name: controller for controller in called}
                if not called:
                    place = Place(self.source, program.operations[0])
                    faults.append(
                        Diagnostic("J113", place, Phrase("T{}, no tool controller has this number", f"{event.value:g}"))
                    )
        self._programs.append(program)
        self.rows += len(program)
        return faults

    def summary(self, job: Any, active: Sequence[Any], fixtures: int) -> str:
        """Number of operations read and number listed in the job."""
        meant = f"{len(active)} meant and active"
        read = f"{len(self._programs)} read" + (f" at {fixtures} fixtures" if fixtures > 1 else "")
        return f"operations of the job: {len(members(job.Operations))} listed, {meant}, {read}"

    def program(self, tools: Mapping[int, Tool]) -> Program:
        """All operations in sequence."""
        names = PROGRAM_COLUMNS.keys() - {"operation"}
        columns = {name: np.concatenate([getattr(program, name) for program in self._programs]) for name in names}
        return Program(
            **columns,
            operation=np.repeat(np.arange(len(self._programs)), [len(program) for program in self._programs]),
            events=without_idle_starts(tuple(self._events), np.flatnonzero(columns["kind"] != Kind.RAPID)),
            operations=tuple(program.operations[0] for program in self._programs),
            tools=dict(tools),
            source=self.source,
        )
