# SPDX-License-Identifier: LGPL-2.1-or-later
"""Single block: run a posted program by lines of its source, stopping after each.

A posted motion program blends corners and runs through line ends at speed, and the controller's own single step ends
after one PVT move, at speed. Single block therefore steps through the trajectory posted with the program: the segments
of one line are planned separately, from rest to rest, and certified like any manual move. Events between two lines that
move belong to the second. A tool change also ends a block. The program's stops (M0, M1) are left out: each block ends
at rest anyway.

Input: a motion program with the other results of its posting. Output: a trajectory for each block, and its text for
display.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import (
    IN_SUBPROGRAM_FILE,
    TRAJECTORY_COLUMNS,
    Diagnostic,
    Diagnostics,
    EventKind,
    Machine,
    Place,
    Trajectory,
    errors,
    threads,
    tool_change_rows,
)
from pkm_post.reading import is_part_program
from pkm_post.system import result_files
from pkm_post.toolpath import modal_events, not_repeated
from pkm_post.writing import manifest, trajectory_file

_MOST_SOURCE = 1 << 28
"""Most bytes read of a source."""


_COOLANT = {0: "M9", 1: "M8", 2: "M7"}
_CODES: dict[EventKind, Callable[[float], str]] = {
    EventKind.TOOL_CHANGE: "T{:g} M6".format,
    EventKind.SPINDLE: lambda speed: f"S{abs(speed):g} M{3 if speed > 0 else 4}" if speed else "M5",
    EventKind.COOLANT: lambda value: _COOLANT[int(value)],
    EventKind.DWELL: "G4 P{:g}".format,
    EventKind.FUNCTION: "M{:g}".format,
}
"""Events between moves as G-code, dwells in seconds; stops are left out."""


@dataclass(frozen=True)
class BlockDisplay:
    """The next block, for display.

    Attributes:
        number: of the block, from 1; ``count`` + 1 when all have run.
        operation: of the job; empty if the source has none.
        line: in the source, or the number of the command in its operation.
        text: that line, or its target in the work frame if the source is unavailable; with the codes executed before
            and after it, separated by bars.
    """

    number: int
    count: int
    operation: str = ""
    line: int = 0
    text: str = ""

    @property
    def is_over(self) -> bool:
        """Whether all blocks have run."""
        return self.number > self.count

    def __str__(self) -> str:
        where = " ".join(filter(None, (self.operation, f"line {self.line}")))
        return f"block {self.number} of {self.count}, {where}: {self.text}"


@dataclass(frozen=True)
class ProgramBlocks:
    """The blocks of a program.

    Attributes:
        trajectory: of the whole program.
        lines: of its source; empty if unavailable.
        begins: (B,) first segment of each block.
    """

    trajectory: Trajectory
    lines: tuple[str, ...]
    begins: Array

    def __len__(self) -> int:
        return len(self.begins)

    def shown(self, number: int) -> BlockDisplay:
        """A block for display, numbered from 1; one past the last for the end."""
        if number > len(self):
            return BlockDisplay(number, len(self))
        first, end = self._rows(number)
        place = self.trajectory.place(first)
        known = 0 < place.line <= len(self.lines) and not place.operation.startswith(IN_SUBPROGRAM_FILE)
        text = self.lines[place.line - 1].strip() if known else self._target(end - 1)
        behind = self._codes(end) if end == len(self.trajectory) else ""
        texts = " | ".join(filter(None, (self._codes(first), text, behind)))
        return BlockDisplay(number, len(self), place.operation, place.line, texts)

    def block(self, number: int) -> Trajectory:
        """A block as a trajectory from rest to rest.

        Args:
            number: of the block, from 1.

        Raises:
            ValueError: there is no such block.
        """
        if not 1 <= number <= len(self):
            raise ValueError(f"number: expected a block from 1 to {len(self)}, got {number}")
        whole, (first, end) = self.trajectory, self._rows(number)
        with_before, at = self._segments(max(first - 1, 0), end), int(first > 0)
        block = self._segments(first, end)
        last = np.arange(len(block)) == len(block) - 1
        behind = end + (end == len(whole))  # events after the last segment belong to it
        events = (each for each in whole.events if first <= each.row < behind and each.kind is not EventKind.STOP)
        return replace(
            block,
            exact_stop=block.exact_stop | last,
            smooth=block.smooth & ~last,
            start_tip=with_before.tip_before()[at],
            start_axis=with_before.axis_before()[at],
            start_spin=float(with_before.spin_before()[at]),
            events=tuple(replace(each, row=each.row - first) for each in events),
        )

    def begun_at(self, number: int, machine: Machine) -> tuple[ProgramBlocks, Diagnostics]:
        """The blocks with spindle and coolant switched in front of one as the blocks before it do; and K152.

        Args:
            number: of the block, from 1.
            machine: its spindle, which starts from rest.
        """
        first, events = self._rows(number)[0], self.trajectory.events
        if first == 0:
            return self, ()
        own = [each for each in events if each.row == first]
        ended: set[EventKind] = {each.kind for each in own if each.kind is not EventKind.DWELL and not each.value}
        if EventKind.SPINDLE in ended or any(each.kind is EventKind.TOOL_CHANGE for each in own):
            ended |= {EventKind.SPINDLE, EventKind.DWELL}  # no start before a stop
        modal = modal_events(self.trajectory, first - 1, machine)
        restored = [replace(each, row=first) for each in modal if each.kind not in ended]
        changed = sorted((*restored, *events), key=lambda each: each.row)  # stable: restored ones come first
        blocks = replace(self, trajectory=replace(self.trajectory, events=tuple(changed)))
        return blocks, not_repeated(self.trajectory, first - 1)

    def _segments(self, first: int, end: int) -> Trajectory:
        """A range of segments; their start is that of the whole."""
        columns = {name: getattr(self.trajectory, name)[first:end] for name in TRAJECTORY_COLUMNS}
        return replace(self.trajectory, **columns, events=())

    def _rows(self, number: int) -> tuple[int, int]:
        """The first segment of a block, and the end of its range."""
        first, *behind = self.begins[number - 1 : number + 1].tolist()
        return first, behind[0] if behind else len(self.trajectory)

    def _codes(self, row: int) -> str:
        """Events in front of a segment, as codes."""
        events = (each for each in self.trajectory.events if each.row == row and each.kind in _CODES)
        return " ".join(_CODES[each.kind](each.value) for each in events)

    def _target(self, row: int) -> str:
        machine_from_work, tip = self.trajectory.machine_from_work, self.trajectory.tip[row]
        x, y, z = machine_from_work[:3, :3].T @ (tip - machine_from_work[:3, 3])
        return f"-> X{x:z.3f} Y{y:z.3f} Z{z:z.3f}"


def split_into_blocks(trajectory: Trajectory, lines: tuple[str, ...] = ()) -> ProgramBlocks:
    """The blocks of a trajectory: segments with the same operation and line, split at tool changes."""
    begins = np.ones(len(trajectory), dtype=np.bool_)
    begins[1:] = (np.diff(trajectory.line) != 0) | (np.diff(trajectory.operation) != 0)
    begins[[row for row in tool_change_rows(trajectory.events) if row < len(trajectory)]] = True
    return ProgramBlocks(trajectory, lines, np.flatnonzero(begins))


def read_blocks(program: Path, machine: Machine) -> tuple[ProgramBlocks | None, Diagnostics]:
    """The blocks of a motion program, from the trajectory posted with it.

    Args:
        program: the motion program, or a part of it, beside the other results of its posting.
    """
    posted, faults = manifest.check(program)
    if errors(faults):
        return None, faults
    names = [] if posted is None else [name for name in posted.files if name.endswith(result_files.TRAJECTORY)]
    if not names:
        return None, (Diagnostic("C205", Place(str(program)), "no manifest beside it lists it with a trajectory"),)
    file = program.with_name(names[0])
    trajectory, faults = trajectory_file.read(file)
    if trajectory is None:
        return None, faults
    if threads(trajectory.events):
        return None, (*faults, Diagnostic("C208", Place(str(file)), "a block of a thread is no motion of its own"))
    if trajectory.machine_fingerprint != machine.fingerprint:
        found = f"made for {trajectory.machine}, to be run on {machine.name}"
        return None, (*faults, Diagnostic("T104", Place(str(file)), found))
    return split_into_blocks(trajectory, _lines_of_source(trajectory, program.parent)), faults


def _lines_of_source(trajectory: Trajectory, folder: Path) -> tuple[str, ...]:
    """Lines of the part program if it is unchanged since posting: under its name, or beside the results."""
    source = Path(trajectory.source)
    if not is_part_program(source):
        return ()
    for file in (source, folder / source.name):
        content = _content(file)
        if hashlib.sha256(content).hexdigest() == trajectory.source_fingerprint:
            return tuple(content.decode("utf-8", "replace").replace("\r\n", "\n").split("\n"))
    return ()


def _content(file: Path) -> bytes:
    try:
        with file.open("rb") as stream:
            return stream.read(_MOST_SOURCE)
    except OSError:
        return b""  # without a source, none is shown
