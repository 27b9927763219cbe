# SPDX-License-Identifier: LGPL-2.1-or-later
"""Greeting: agree on the handshake with a controller of which nothing is known yet.

A controller may be in the middle of anything: a program buffer may be open, and then an assignment would become a line
of the program. So ``SIZE`` is asked first, whose sign tells, before anything is set.

Enters: a dialogue, and what becomes of an open buffer. Leaves: a controller that can be understood, and notes in words.
"""

from __future__ import annotations

import re
from enum import Enum

from pkm_post.pmac_link.dialogue import Dialogue
from pkm_post.pmac_link.faults import LinkLostError, NotReadyError, RefusedError


class Leftover(Enum):
    """What becomes of a program buffer that is found open while connecting."""

    REFUSE = "refuse"
    """Somebody may be loading a program: nothing is done."""
    JOIN = "join"
    """As well, but a rotary buffer with lines in it is left open: who only asks, or goes on, does not disturb it."""
    CLEAR = "clear"
    """It is made empty and closed: the rest of a download that was cut must not be run. A rotary one is joined."""
    CLOSE = "close"
    """It is closed as it is, by a download that asks what is in it."""

    @property
    def on_the_way(self) -> Leftover:
        """What holds when a link that was lost comes back: what is in the buffer may be one's own then."""
        return Leftover.CLOSE if self is Leftover.CLEAR else self


_LEAVES_IT = (Leftover.REFUSE, Leftover.JOIN)
_JOINS = (Leftover.JOIN, Leftover.CLEAR)
_HANDSHAKE = re.compile(r"(I\d+)=(\d+)")
_NEGATIVE = re.compile(r"(?:^|[^0-9A-Za-z$.])-\s?\d+")


def greet(dialogue: Dialogue, leftover: Leftover) -> list[str]:
    """Connect and agree; what was found and done.

    Raises:
        LinkLostError: nobody answers, or not as was agreed.
        NotReadyError: a program buffer is open, and it is not to be touched.
    """
    dialogue.restart()
    if not dialogue.handshake:
        return []
    is_open = _finds_open_buffer(dialogue)
    ahead = _lines_ahead(dialogue) if is_open and leftover in _JOINS else 0
    notes = [f"a rotary buffer is open, with {ahead} lines ahead of its program"] if ahead else []
    if ahead and _is_agreed(dialogue):
        return notes  # who streams must not lose them in the middle of a move
    if is_open and leftover in _LEAVES_IT:
        raise NotReadyError(
            ["a program buffer is open: somebody loads a program, or a download was cut; no program runs meanwhile"]
        )
    clears = is_open and leftover is Leftover.CLEAR and not ahead
    if clears:
        dialogue.blind("CLEAR")
    if leftover not in _LEAVES_IT:
        dialogue.blind("CLOSE")
    dialogue.blind(dialogue.handshake)
    if not _is_agreed(dialogue):
        raise LinkLostError(f"the controller does not keep {dialogue.handshake}")
    return notes + ([_what_became_of_it(dialogue)] if clears else [])


def _is_agreed(dialogue: Dialogue) -> bool:
    """Whether the controller answers as the conversation expects."""
    names, values = zip(*_HANDSHAKE.findall(dialogue.handshake), strict=True)
    try:
        return dialogue.query(" ".join(names)) == values
    except (LinkLostError, RefusedError):
        return False


def _lines_ahead(dialogue: Dialogue) -> int:
    """Lines in the rotary buffer that the program has not begun."""
    found = re.match(r"\s*(\d+)", dialogue.blind("PR"))
    return int(found[1]) if found else 0


def _finds_open_buffer(dialogue: Dialogue) -> bool:
    """SIZE is negative while a program buffer is open; asked while nobody knows how the answer is framed."""
    told = dialogue.blind("SIZE")
    if not re.search(r"\d", told):
        raise LinkLostError(f"SIZE: expected a number of words, got {told!r}")
    return bool(_NEGATIVE.search(told))


def _what_became_of_it(dialogue: Dialogue) -> str:
    (free,) = dialogue.query("SIZE")[:1] or ("",)
    if free.startswith("-"):
        return "a program buffer is open on another port of the controller: somebody else is loading a program"
    return "a program buffer was open, the rest of a download that was cut: it was made empty"
