# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings: the configuration of the simulated controller and its motors."""

from __future__ import annotations

from dataclasses import dataclass

from pkm_post.control.simulator.machine_codes import MACHINE_CODES

LEAST_MEMORY = 1000
"""words: room for the machine codes."""


@dataclass(frozen=True, kw_only=True)
class SimulatorSettings:
    """A controller and its motors.

    Attributes:
        memory_words: program memory, in 48-bit words.
        line_limit: longest line, in characters.
        tick_ms: period of the position update.
        lag_ms: time constant of the servo loops: at constant speed the following error is the speed times this.
        home_flag: position of the home flags after a reset, counts from the motors' positions.
        firmware: answer to VER.
        card: answer to TYPE.
        identity: answer to CID.
        password: protects programs from 1000 on; empty for none.
        machine_codes: lines loaded at a reset: the programs behind G, M, T and D codes.
    """

    memory_words: int = 237_568
    line_limit: int = 255
    tick_ms: float = 1.0
    lag_ms: float = 0.5
    home_flag: float = 5000.0
    firmware: str = "1.947"
    card: str = "TURBO2, X4"
    identity: str = "602413"
    password: str = ""
    machine_codes: tuple[str, ...] = MACHINE_CODES

    def __post_init__(self) -> None:
        if self.memory_words < LEAST_MEMORY:
            raise ValueError(f"memory_words: expected {LEAST_MEMORY} or more, got {self.memory_words}")
        if not (self.tick_ms > 0 and self.lag_ms > 0):
            raise ValueError(f"expected times above zero, got tick_ms {self.tick_ms}, lag_ms {self.lag_ms}")
