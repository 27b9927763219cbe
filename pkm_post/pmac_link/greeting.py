# SPDX-License-Identifier: LGPL-2.1-or-later
"""Greeting: agree on the handshake with a controller of which nothing is known yet.

A controller may be in the middle of anything: a program buffer may be open, and then an assignment would become a line
of the program. So ``SIZE`` is asked first, whose sign tells, before anything is set; and nothing is set that is so.

Enters: a dialogue, and what becomes of an open buffer. Leaves: a controller that can be understood.
"""

from __future__ import annotations

import re
from enum import Enum

from pkm_post.pmac_link.dialogue import Dialogue
from pkm_post.pmac_link.exchange import Answer, Command, Kind
from pkm_post.pmac_link.faults import LinkLostError


class Leftover(Enum):
    """What becomes of a program buffer that is found open while connecting."""

    LEAVE = "leave"
    """It stays as it is: who watches disturbs nobody, and who wants to load asks first whose it is (``ownership``)."""
    STOP = "stop"
    """As well, if the controller answers as is agreed; else it is closed, for a stop is more urgent than to load."""
    CLOSE = "close"
    """It is closed as it is, by its owner, whose link came back and who asks what is in it."""


_HANDSHAKE = re.compile(r"(I\d+)=(\d+)")
_NEGATIVE = re.compile(r"(?:^|[^0-9A-Za-z$.])-\s?\d+")


def greet(dialogue: Dialogue, leftover: Leftover) -> None:
    """Connect and agree.

    Raises:
        LinkLostError: nobody answers, or not as was agreed.
    """
    dialogue.restart()
    if not dialogue.handshake:
        return
    is_open = _finds_open_buffer(dialogue)
    if leftover is Leftover.CLOSE:
        dialogue.blind("CLOSE")
    if _is_agreed(dialogue):
        return  # an assignment might become a line of a program that somebody begins to load just now
    if is_open and leftover is Leftover.LEAVE:
        raise LinkLostError("a program buffer is open, and the answers are not as is agreed: abort closes it")
    dialogue.blind("CLOSE")
    dialogue.blind(dialogue.handshake)
    if not _is_agreed(dialogue):
        raise LinkLostError(f"the controller does not keep {dialogue.handshake}")


def _is_agreed(dialogue: Dialogue) -> bool:
    """Whether the controller answers as the conversation expects."""
    names, values = zip(*_HANDSHAKE.findall(dialogue.handshake), strict=True)
    ended = dialogue.run(Command(" ".join(names), Kind.QUERY, dialogue.patience))
    return isinstance(ended, Answer) and ended.lines == values


def _finds_open_buffer(dialogue: Dialogue) -> bool:
    """SIZE is negative while a program buffer is open; asked while nobody knows how the answer is framed."""
    told = dialogue.blind("SIZE")
    if not re.search(r"\d", told):
        raise LinkLostError(f"SIZE: expected a number of words, got {told!r}")
    return bool(_NEGATIVE.search(told))
