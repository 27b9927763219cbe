# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program memory: load, list and delete a program in a Turbo PMAC or a Power PMAC.

A Turbo PMAC appends to an open program until ``CLEAR``, and ``SIZE`` gives its free words, negative while a buffer is
open [TurboPMAC, OPEN, SIZE]. A Power PMAC erases a program on opening it; a program closed without lines ceases to
exist, and listing it gives error #22 [PowerPMAC, open prog; Error Codes]. ``list prog`` lists it, as Diamond Light
Source's program backup relies on [dls_powerpmacanalyse]. Its free memory is not queried: a line without room gives
error #34.

Input: a session and a program number. Output: commands, and the lines of a listing.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from pkm_post.control.link.errors import LinkLostError, PmacError, RefusedError
from pkm_post.control.link.program import PmacProgram
from pkm_post.control.link.session import Session, free_memory

_HEADING = re.compile(r"open\s*prog\s*\d+\s*;?", re.IGNORECASE)
_ENDING = re.compile(r"close\s*;?", re.IGNORECASE)


@dataclass(frozen=True)
class ProgramMemory:
    """The program memory of one kind of controller.

    Attributes:
        opening: lines that open a program; ``{}`` is its number.
        emptying: the line that empties an open program; empty if opening does so.
        closing: the line that closes it.
        listing: the query that lists it.
        absent: errors of a listing if there is no program of this number.
        has_size: whether ``SIZE`` gives the free memory.
    """

    opening: tuple[str, ...]
    emptying: str
    closing: str
    listing: str
    absent: tuple[int, ...]
    has_size: bool

    @property
    def can_append(self) -> bool:
        """Whether lines can be appended to a reopened program."""
        return bool(self.emptying)

    def open(self, session: Session, number: int) -> None:
        """Open a program, after closing one that this session may have left open."""
        if not self.has_size and session.has_open_buffer:
            session.command(self.closing)
        for line in self.opening:
            session.command(line.format(number))

    def empty(self, session: Session) -> None:
        """Empty the open program."""
        if self.emptying:
            session.command(self.emptying)

    def close(self, session: Session) -> None:
        """Close the open program."""
        session.command(self.closing)

    def listed(self, session: Session, program: PmacProgram) -> tuple[str, ...]:
        """The lines that the controller lists under the number of a program; empty if there is no such program."""
        most = 3 * sum(map(len, program.lines)) + (1 << 16)
        try:
            lines = session.query(self.listing.format(program.number), most)
        except RefusedError as refused:
            if refused.number not in self.absent:
                raise
            return ()
        return lines if self.has_size else _body(lines)

    def is_closed(self, session: Session) -> bool:
        """Whether no program buffer is open; on a Power PMAC, none of this thread."""
        return free_memory(session) >= 0 if self.has_size else not session.has_open_buffer

    def check_room(self, session: Session, program: PmacProgram) -> None:
        """Compare the size of a program with the free memory, if the controller reports it.

        Raises:
            PmacError: it is too large.
        """
        if self.has_size and (free := free_memory(session)) < program.words:
            raise PmacError(f"the program takes about {program.words} words, the controller has {free}")


TURBO = ProgramMemory(
    ("CLOSE", "DELETE GATHER", "OPEN PROG {}"), "CLEAR", "CLOSE", "LIST PROG {}", (3, 5, 15), has_size=True
)
POWER = ProgramMemory(("open prog {}",), "", "close", "list prog {}", (22,), has_size=False)


def memory_of(session: Session) -> ProgramMemory:
    """The program memory of the controller that a session talks to."""
    return TURBO if session.has_handshake else POWER


def _body(lines: tuple[str, ...]) -> tuple[str, ...]:
    """The lines of a listing without ``;`` and without the frame of a program, which is optional.

    Raises:
        LinkLostError: the listing is cut inside the frame.
    """
    found = [line.strip().rstrip(";").rstrip() for line in lines if line.strip()]
    if found and _HEADING.fullmatch(found[0]):
        if not _ENDING.fullmatch(found[-1]):
            raise LinkLostError(f"the listing begins with {found[0]!r} and ends with {found[-1]!r}")
        found = found[1:-1]
    return tuple(found)
