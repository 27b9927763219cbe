# SPDX-License-Identifier: LGPL-2.1-or-later
"""Prepared: the inputs of a pipeline run, for every entry point.

Enters: a program, its machine and the options, with the diagnostics from reading them. Documents and user files are no
longer needed, so a run can continue in any thread.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from pkm_post.model import Machine, Program, Refused, Trajectory, errors
from pkm_post.options import Options
from pkm_post.posting.frame import Posted
from pkm_post.posting.placed import trajectory_of
from pkm_post.posting.run import Findings, Log, Progress, quiet, unwatched
from pkm_post.posting.steps import post


@dataclass(frozen=True)
class Prepared:
    """A program on its machine, before it is placed.

    Attributes:
        program: cutter locations in {C}; None if it has errors.
        machine: the machine it runs on; None if its file has errors.
        options: the user's choices.
        found: diagnostics from reading them.
    """

    program: Program | None
    machine: Machine | None
    options: Options
    found: Findings

    @property
    def sound(self) -> tuple[Program, Machine]:
        """Program and machine.

        Raises:
            Refused: one of them or the options have an error.
        """
        if self.program is None or self.machine is None or errors(self.found):
            raise Refused(self.found)
        return self.program, self.machine

    def placed(self) -> tuple[Trajectory, Findings]:
        """The trajectory in {M}, and all diagnostics.

        Raises:
            Refused: it cannot be read or placed.
        """
        trajectory, told = trajectory_of(*self.sound, self.options)
        if trajectory is None:
            raise Refused((*self.found, *told))
        return trajectory, (*self.found, *told)

    def post(self, program_path: Path, log: Log = quiet, progress: Progress = unwatched) -> Posted:
        """Post it to a motion program of this name; the other files take its stem.

        Raises:
            Refused: an input has an error; nothing was written.
        """
        return post(self.program, self.machine, program_path, self.options, log, self.found, progress)
