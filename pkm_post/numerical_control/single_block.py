# SPDX-License-Identifier: LGPL-2.1-or-later
"""Single block: a program in the pieces between its rests, each of them a program of its own.

The controller's own single step ends behind one move, and a PVT move ends at speed. Between two rests there is nothing
to step to. So the program is cut where every printed speed is zero, as it is for parts: a block begins at the very
lengths where the one before it ended, and what happens at a rest belongs to the block behind it. When a block has
ended, the machine stands and no program runs; nothing else has to hold. The stops of the program (M0, M1) are left out:
a block ends at each of them anyway.

Enters: a program that was read. Leaves: jobs, one for each block, whose motions together are its motion.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.controllers.pmac import Settings, program_text
from pkm_post.controllers.pvt.parts import parted
from pkm_post.controllers.pvt.writer import rests
from pkm_post.model import EventKind, StrutMotion
from pkm_post.numerical_control.defaults import OWN_PROGRAM
from pkm_post.pmac_link.job import Job, read_job


@dataclass(frozen=True)
class Blocks:
    """The blocks of a program.

    Attributes:
        motions: of the blocks, in order.
        settings: of the controller, with the number that blocks run under.
    """

    motions: tuple[StrutMotion, ...]
    settings: Settings

    def __len__(self) -> int:
        return len(self.motions)

    def job(self, number: int) -> Job:
        """A block as a program.

        Args:
            number: of the block, from 1.

        Raises:
            ValueError: there is no such block, or its text does not give its motion back.
        """
        if not 1 <= number <= len(self.motions):
            raise ValueError(f"number: expected a block from 1 to {len(self.motions)}, got {number}")
        return job_of(self.motions[number - 1], self.settings, f"block {number} of {len(self.motions)}")


def blocks_of(job: Job, settings: Settings, number: int = OWN_PROGRAM) -> Blocks:
    """The blocks of a program.

    Args:
        job: the program.
        settings: of the controller it was written for.
        number: of the program that blocks run under.

    Raises:
        ValueError: the number is that of the jobs.
    """
    if number == settings.program:
        raise ValueError(f"number: expected another one than that of the jobs, got {number}")
    last = len(job.motion) - 1
    cuts = [int(knot) for knot in rests(job.motion, settings) if 0 < knot < last]
    events = tuple(event for event in job.motion.events if event.kind is not EventKind.STOP)
    return Blocks(parted(replace(job.motion, events=events), cuts), replace(settings, program=number))


def job_of(motion: StrutMotion, settings: Settings, name: str) -> Job:
    """A piece of a program as a program.

    Args:
        motion: of the piece.
        settings: of the controller, with the number it runs under.
        name: what it is.

    Raises:
        ValueError: its text does not give its motion back.
    """
    job, faults = read_job(program_text(motion, settings, [name]), settings, name)
    if job is None or not same(job.motion, motion):
        raise ValueError(f"{name}: expected a text that gives its motion back, got {faults}")
    return job


def same(one: StrutMotion, other: StrutMotion) -> bool:
    """Whether two motions are one, to the last digit."""
    return one.events == other.events and all(
        np.array_equal(getattr(one, name), getattr(other, name)) for name in ("time_ms", "length", "speed")
    )
