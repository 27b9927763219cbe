# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kinds: the controllers by the ``controller.kind`` of the machine file, and what each of them offers.

A machine enters, the module of its controller leaves. The motion it is given is in mm, mm/s and whole ms.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePath
from typing import Any, Protocol

from pkm_post.controllers import pmac, power_pmac
from pkm_post.model import Diagnostic, Machine, Place, StrutMotion

Findings = tuple[Diagnostic, ...]


class Controller(Protocol):
    """What the module of a controller offers. Settings are a class of its own.

    Attributes:
        SETUP_SUFFIX: how the name of the set-up file goes on behind that of the job.
    """

    SETUP_SUFFIX: str

    def settings_of(self, machine: Machine) -> tuple[Any | None, Findings]:
        """The settings of a machine's controller, or why there are none."""

    def faults(self, motion: StrutMotion, settings: Any, file: str) -> Findings:
        """Why a motion cannot be written, for the job of this name."""

    def program_parts(self, motion: StrutMotion, settings: Any, heading: Sequence[str]) -> tuple[str, ...]:
        """The program, in one text or in several that run one after the other."""

    def stated_part(self, text: str) -> tuple[int, int]:
        """Which part a program says it is, and of how many."""

    def read_parts(self, texts: Sequence[tuple[str, str]], settings: Any) -> tuple[StrutMotion | None, Findings]:
        """The motion of a program, from file name and text of each of its parts."""

    def setup_text(self, settings: Any, machine_name: str, stroke: tuple[float, float]) -> str | None:
        """The set-up that programs rely on, None when there is none; the stroke in mm."""


CONTROLLERS: dict[str, Controller] = {"turbo_pmac": pmac, "power_pmac": power_pmac}


def controller_of(machine: Machine) -> tuple[Controller | None, Findings]:
    """The controller of a machine, or why there is none."""
    kind = machine.controller.get("kind")
    if kind in CONTROLLERS:
        return CONTROLLERS[kind], ()
    found = f"controller.kind: expected one of {', '.join(CONTROLLERS)}, got {kind!r}"
    return None, (Diagnostic("M104", Place(machine.name), found),)


def controller_settings(machine: Machine) -> tuple[tuple[Controller, Any] | None, Findings]:
    """The controller of a machine and its settings, or what stands against writing a program for it.

    Posting and checking a machine file ask this one function, so that a file that is complete can be posted for.
    """
    controller, faults = controller_of(machine)
    if controller is None:
        return None, faults
    settings, faults = controller.settings_of(machine)
    return (None if settings is None else (controller, settings)), faults


def part_names(name: str, count: int) -> list[str]:
    """The names of the parts of a file; the first, or the only one, has the name itself."""
    path = PurePath(name)
    return [name, *(f"{path.stem}-part{number}{path.suffix}" for number in range(2, count + 1))]


def part_siblings(controller: Controller, name: str, text: str) -> list[str]:
    """The names of the other parts of a program, as its first part states them."""
    number, count = controller.stated_part(text)
    return part_names(name, count)[1:] if number == 1 else []
