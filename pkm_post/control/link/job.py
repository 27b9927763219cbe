# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job: a program file, parsed as the controller would parse it before a byte of it is sent.

Enters: the text of a program or one part of it, and the settings it was written for. Leaves: its lines and its motion
in mm, or what is wrong with it.
"""

from __future__ import annotations

from dataclasses import dataclass

from pkm_post.control.link.listing import Program, program_of
from pkm_post.control.link.status import Array
from pkm_post.model import Diagnostic, StrutMotion
from pkm_post.writing import PmacSettings, read_part


@dataclass(frozen=True)
class Job:
    """A program that is valid to send.

    Attributes:
        program: the lines for the controller.
        motion: its strut motion.
    """

    program: Program
    motion: StrutMotion

    @property
    def first(self) -> Array:
        """(6,) strut lengths at its first point, mm."""
        return self.motion.length[0]


def read_job(text: str, settings: PmacSettings, file: str) -> tuple[Job | None, tuple[Diagnostic, ...]]:
    """Read a program file.

    Args:
        text: of the file. A part of a larger program is read separately.
        settings: of the machine's controller.
        file: its name, for diagnostics.
    """
    motion, faults = read_part(text, settings, file)
    if motion is None:
        return None, faults
    return Job(program_of(text), motion), faults
