# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run: log, progress and diagnostics of one run, the context of its steps, and its result.

Log and progress are callbacks; warnings are collected, errors stop the run.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from pkm_post.machine import Collisions, find_collisions
from pkm_post.model import Diagnostic, Diagnostics, Machine, Refused, Setup, Tolerances, Trajectory, checkpoints, errors
from pkm_post.options import Options
from pkm_post.system import result_files
from pkm_post.writing import ControllerModule, manifest

T = TypeVar("T")
Log = Callable[[str], None]
"""Receives a line."""
Progress = Callable[[str, float], None]
"""Receives the name of the step and the completed share of the work, 0 to 1: at the start of a step, and a few times a
second during it; at the end an empty name and 1. An exception from it stops the run, and no files remain."""
CollisionSearch = Callable[[Trajectory, Machine, Setup, Tolerances], Collisions]
"""``machine.find_collisions``, or a function that keeps its results."""
_PROGRESS_PERIOD = 0.1
"""s: least time between two calls of progress within a step."""
_HALF_OF_A_STEP = 1.0
"""s: within a step of unknown duration, the share approaches that of its end: half of the way in this time, two thirds
in twice the time."""


def no_log(line: str) -> None:
    """Log nothing."""


def no_progress(step: str, share: float) -> None:
    """Ignore progress, and never stop the run."""


@dataclass
class Run:
    """One run through the pipeline: logs and times its steps, and stops at errors.

    Attributes:
        log: receives a line for each step.
        progress: called at the start of each step.
        shares: share of the work of each step, by name, in any unit.
        warnings: warnings so far.
        raised_outside: OSError from log or progress, which must not be mistaken for a fault of the written files.
    """

    log: Log
    progress: Progress
    shares: Mapping[str, float]
    warnings: list[Diagnostic] = field(default_factory=list)
    raised_outside: OSError | None = None

    def accept(self, diagnostics: Diagnostics) -> None:
        """Collect warnings, stop at errors."""
        if errors(diagnostics):
            raise Refused((*self.warnings, *diagnostics))
        self.warnings.extend(diagnostics)

    def value(self, result: tuple[T | None, Diagnostics]) -> T:
        """Accept the diagnostics of a step and return its value."""
        value, diagnostics = result
        self.accept(diagnostics)
        if value is None:
            raise ValueError("expected a value or an error, got neither")
        return value

    @contextlib.contextmanager
    def step(self, name: str) -> Iterator[list[str]]:
        """Report the start of a step; at its end log its time and the notes added to the list."""
        give_back_memory()
        done = self._done_before(name)
        self._call(self.progress, name, done)
        notes: list[str] = []
        begin = time.perf_counter()
        weight = self.shares[name] / sum(self.shares.values())
        try:
            with checkpoints(beat(lambda within: self._call(self.progress, name, done + weight * within))):
                yield notes
        except MemoryError as fault:
            fault.add_note(f"in the step {name}")
            raise
        self._call(self.log, f"{name:<22}{time.perf_counter() - begin:7.2f} s   {', '.join(notes)}")

    @contextlib.contextmanager
    def goes_on(self) -> Iterator[None]:
        """Continue the last step, for work that belongs to all steps."""
        name = [*self.shares][-1]
        with checkpoints(beat(lambda _: self._call(self.progress, name, 1.0))):
            yield

    def print(self, lines: Iterable[str]) -> None:
        """Log additional lines."""
        for line in lines:
            self._call(self.log, line)

    def end(self) -> None:
        """Report that all steps are done."""
        self._call(self.progress, "", 1.0)

    def _call(self, callback: Callable[..., None], *what: object) -> None:
        try:
            callback(*what)
        except OSError as fault:
            self.raised_outside = fault
            raise

    def _done_before(self, name: str) -> float:
        names = list(self.shares)
        done = sum(self.shares[before] for before in names[: names.index(name)])
        return done / sum(self.shares.values())


def beat(progress: Callable[[float], None]) -> Callable[[], None]:
    """Make a checkpoint callback that reports the estimated share of a step a few times a second."""
    begin = last = time.monotonic()

    def visit() -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= _PROGRESS_PERIOD:
            last = now
            progress((now - begin) / (now - begin + _HALF_OF_A_STEP))

    return visit


def give_back_memory() -> None:
    """Return free memory to the system: glibc keeps the gaps left by columns of some megabytes."""
    if sys.platform == "linux":
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # other C libraries have none
        if trim is not None:
            trim(0)


class Posted(NamedTuple):
    """The result of posting.

    Attributes:
        program: the motion program, or the first of its parts.
        files: all files written, including the program.
        report: the content of the report file.
        diagnostics: warnings.
        parts: the files of the motion program, in order of execution.
    """

    program: Path
    files: tuple[Path, ...]
    report: dict[str, Any]
    diagnostics: Diagnostics
    parts: tuple[Path, ...]


@dataclass(frozen=True)
class PostContext:
    """Context of all steps.

    Attributes:
        path: path of the motion program; the other files take its folder and its stem.
        settings: settings of the controller, of its own class.
        search: finds the collisions.
    """

    path: Path
    machine: Machine
    controller: ControllerModule
    settings: Any
    options: Options
    search: CollisionSearch = find_collisions

    @property
    def tolerances(self) -> Tolerances:
        """The requested tolerances."""
        return self.options.tolerances

    @property
    def trajectory(self) -> Path:
        """The path of the trajectory file."""
        return self.sibling(result_files.TRAJECTORY)

    @functools.cached_property
    def trajectory_hash(self) -> str:
        """Fingerprint of the trajectory file, which does not change after it was read back."""
        return manifest.fingerprint_of_file(self.trajectory)

    def sibling(self, ending: str) -> Path:
        """The path of an accompanying file."""
        return self.path.with_name(self.path.stem + ending)
