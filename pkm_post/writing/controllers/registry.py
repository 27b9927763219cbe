# SPDX-License-Identifier: LGPL-2.1-or-later
"""Registry: the controllers by the ``controller.kind`` of the machine file, and the tables by their option value.

Input: a machine. Output: the module of its controller, which takes motion in mm, mm/s and whole ms. A table is an
optional output of the certified motion; it is not a program, but it is read back and compared with the motion.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import PurePath
from typing import Any, Protocol, TypeVar, cast

from pkm_post.model import Diagnostic, Diagnostics, Machine, Place, StrutMotion

Module = TypeVar("Module")


class ControllerModule(Protocol):
    """The interface of a controller module. Settings are a class of its own.

    Attributes:
        SETUP_SUFFIX: suffix of the set-up file, appended to the name of the job.
    """

    SETUP_SUFFIX: str

    def settings_of(self, machine: Machine) -> tuple[Any | None, Diagnostics]:
        """The settings of a machine's controller, or None with diagnostics."""

    def faults(self, motion: StrutMotion, settings: Any, file: str) -> Diagnostics:
        """The reasons why a motion cannot be written, for the job of this name."""

    def program_parts(self, motion: StrutMotion, settings: Any, heading: Sequence[str]) -> tuple[str, ...]:
        """The program, as one text or as several that run in sequence."""

    def stated_part(self, text: str) -> tuple[int, int]:
        """The part number that a program states, and the number of parts."""

    def read_parts(self, texts: Sequence[tuple[str, str]], settings: Any) -> tuple[StrutMotion | None, Diagnostics]:
        """The motion of a program, from file name and text of each of its parts."""

    def setup_text(self, settings: Any, machine_name: str, stroke: tuple[float, float]) -> str | None:
        """The set-up that programs rely on, None if there is none; the stroke in mm."""


class _Modules(Mapping[str, Module]):
    """Modules beside this one, by name; each is imported on first use."""

    def __init__(self, names: Mapping[str, str]) -> None:
        self._names = names

    def __getitem__(self, key: str) -> Module:
        return cast(Module, importlib.import_module(f"{__package__}.{self._names[key]}"))

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


CONTROLLERS: Mapping[str, ControllerModule] = _Modules({"turbo_pmac": "pmac", "power_pmac": "power_pmac"})


def controller_of(machine: Machine) -> tuple[ControllerModule | None, Diagnostics]:
    """The controller of a machine, or None with diagnostics."""
    kind = machine.controller.get("kind")
    if isinstance(kind, str) and kind in CONTROLLERS:
        return CONTROLLERS[kind], ()
    found = f"controller.kind: expected one of {', '.join(CONTROLLERS)}, got {kind!r}"
    return None, (Diagnostic("M104", Place(machine.name), found),)


def controller_settings(machine: Machine) -> tuple[tuple[ControllerModule, Any] | None, Diagnostics]:
    """The controller of a machine and its settings, or None with diagnostics.

    Posting and the machine file check share this function, so a file that passes the check can be posted for.
    """
    controller, faults = controller_of(machine)
    if controller is None:
        return None, faults
    settings, faults = controller.settings_of(machine)
    return (None if settings is None else (controller, settings)), faults


def part_names(name: str, count: int) -> list[str]:
    """The names of the parts of a file; the first, or only, part keeps the name."""
    path = PurePath(name)
    return [name, *(f"{path.stem}-part{number}{path.suffix}" for number in range(2, count + 1))]


def part_siblings(controller: ControllerModule, name: str, text: str) -> list[str]:
    """The names of the other parts of a program, as stated by its first part."""
    number, count = controller.stated_part(text)
    return part_names(name, count)[1:] if number == 1 else []


class Table(Protocol):
    """The interface of a table module.

    Attributes:
        SUFFIX: suffix of its file, appended to the name of the job.
    """

    SUFFIX: str

    def texts(self, motion: StrutMotion, heading: Sequence[str]) -> tuple[str, ...]:
        """The table, as one text or several; the heading is for the user."""

    def measured(self, texts: Sequence[tuple[str, str]], motion: StrutMotion) -> tuple[str, Diagnostics]:
        """Read file names and texts back and compare them with the motion: the result as text, and the faults."""


TABLES: Mapping[str, Table] = _Modules({"csv": "motion_csv", "halstreamer": "halstreamer"})
"""Tables by option value."""
