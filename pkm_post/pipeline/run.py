# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run: what goes with the steps of one run: what is told, how far it is, and what was found.

Lines and shares leave through the calls that were given; warnings are kept, errors stop the run.
"""

from __future__ import annotations

import contextlib
import ctypes
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

from pkm_post.model import Diagnostic, Refused
from pkm_post.model.diagnostics import errors

T = TypeVar("T")
Findings = tuple[Diagnostic, ...]
Log = Callable[[str], None]
"""Takes a line."""
Progress = Callable[[str, float], None]
"""Takes the name of the step that begins, and the share of the work that is done, 0 to 1; at the end an empty name and
1. What it raises stops the run, and nothing is left behind."""


def quiet(line: str) -> None:
    """Log nothing."""


def unwatched(step: str, share: float) -> None:
    """Tell nobody how far the run is, and never stop it."""


@dataclass
class Run:
    """One run through the pipeline: says what it does, times it, and stops at errors.

    Attributes:
        log: takes a line for each step.
        progress: is told at the beginning of each step.
        shares: how much of the work each step is, by its name, in any unit.
        warnings: found so far.
        raised_outside: what log or progress raised, if that could be taken for a fault of our own files.
    """

    log: Log
    progress: Progress
    shares: Mapping[str, float]
    warnings: list[Diagnostic] = field(default_factory=list)
    raised_outside: OSError | None = None

    def accept(self, diagnostics: Findings) -> None:
        """Keep warnings, stop at errors."""
        if errors(diagnostics):
            raise Refused((*self.warnings, *diagnostics))
        self.warnings.extend(diagnostics)

    def value(self, result: tuple[T | None, Findings]) -> T:
        """The value of a step that may have found faults."""
        value, diagnostics = result
        self.accept(diagnostics)
        if value is None:
            raise ValueError("expected a value or an error, got neither")
        return value

    @contextlib.contextmanager
    def step(self, name: str) -> Iterator[list[str]]:
        """Tell that a step begins; log it at its end with its time and what it adds to the list."""
        give_back_memory()
        self._tell(self.progress, name, self._done_before(name))
        told: list[str] = []
        begin = time.perf_counter()
        try:
            yield told
        except MemoryError as fault:
            fault.add_note(f"in the step {name}")
            raise
        self._tell(self.log, f"{name:<22}{time.perf_counter() - begin:7.2f} s   {', '.join(told)}")

    def print(self, lines: Iterable[str]) -> None:
        """Log lines beside those of the steps."""
        for line in lines:
            self._tell(self.log, line)

    def end(self) -> None:
        """Tell that all steps are done."""
        self._tell(self.progress, "", 1.0)

    def _tell(self, call: Callable[..., None], *what: object) -> None:
        try:
            call(*what)
        except OSError as fault:
            self.raised_outside = fault
            raise

    def _done_before(self, name: str) -> float:
        names = list(self.shares)
        done = sum(self.shares[before] for before in names[: names.index(name)])
        return done / sum(self.shares.values())


def give_back_memory() -> None:
    """Give what is free back to the system: glibc keeps what columns of some megabytes leave between others."""
    if sys.platform == "linux":
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # other C libraries have none
        if trim is not None:
            trim(0)
