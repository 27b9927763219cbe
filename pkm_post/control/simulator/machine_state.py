# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine state: the parts of a controller that on-line commands read and change."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from pkm_post.control.simulator.coordinate_system import CoordinateSystem
    from pkm_post.control.simulator.expressions import Scanner
    from pkm_post.control.simulator.memory import Memory
    from pkm_post.control.simulator.motors import Motors
    from pkm_post.control.simulator.variables import Variables


class CommandSettings(Protocol):
    """Settings that on-line commands depend on."""

    @property
    def password(self) -> str:
        """Password of protected programs; empty for none."""

    @property
    def firmware(self) -> str:
        """Answer to VER."""

    @property
    def card(self) -> str:
        """Answer to TYPE."""

    @property
    def identity(self) -> str:
        """Answer to CID."""


class MachineState(Protocol):
    """A controller, as on-line commands see it; ``controller.Controller`` is one."""

    motors: Motors
    systems: list[CoordinateSystem]
    memory: Memory
    variables: Variables
    unlocked: bool

    @property
    def settings(self) -> CommandSettings:
        """The settings."""

    def system_of(self, motor: int) -> CoordinateSystem | None:
        """Coordinate system of a motor."""

    def rotary_full(self, number: int) -> bool:
        """Whether the rotary buffer of a coordinate system is full."""

    def runs_program(self) -> bool:
        """Whether any coordinate system runs a program."""

    def forget_pointers(self) -> None:
        """Forget the program pointers, as after a change of programs."""

    def initialize(self) -> None:
        """Set everything to its default."""

    def reset(self) -> None:
        """Restart with the saved state."""

    def save(self) -> None:
        """Save the state for the next restart."""

    def kill(self, index: int) -> None:
        """Open the servo loop of a motor; its index, from 0."""

    def kill_all(self) -> None:
        """Open all servo loops."""


Handler = Callable[["PortSession", re.Match[str], "Scanner"], list[str]]
"""Executes a command; returns its answer."""


@dataclass(eq=False)
class PortSession:
    """The sender of commands, and the motor and coordinate system it addresses.

    Attributes:
        controller: that executes them.
        motor: addressed by ``#n``.
        system: addressed by ``&n``.
        bank: eight motors, addressed by ``##n``.
    """

    controller: MachineState
    motor: int = 1
    system: int = 1
    bank: int = 0
