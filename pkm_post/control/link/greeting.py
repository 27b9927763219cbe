# SPDX-License-Identifier: LGPL-2.1-or-later
"""Greeting: establish the handshake with a controller in an unknown state.

A program buffer may be open, and then an assignment would become a line of the program. So before anything is set,
``SIZE`` is queried, whose sign reveals an open buffer; values that are already right are not set.

Enters: a dialogue, and what to do with an open buffer. Leaves: a controller whose answers can be parsed.
"""

from __future__ import annotations

import re
from enum import Enum

from pkm_post.control.link.dialogue import Dialogue
from pkm_post.control.link.exchange import Answer, Command, Kind
from pkm_post.control.link.faults import LinkLostError


class Leftover(Enum):
    """What to do with a program buffer that is open when connecting."""

    LEAVE = "leave"
    """Leave it: a client that only monitors disturbs no one, and loading checks its owner first (``ownership``)."""
    STOP = "stop"
    """Leave it if the handshake is as agreed, else close it: a stop takes precedence over a download."""
    CLOSE = "close"
    """Close it: its owner reconnects and queries its contents."""


_HANDSHAKE = re.compile(r"(I\d+)=(\d+)")
_NEGATIVE = re.compile(r"(?:^|[^0-9A-Za-z$.])-\s?\d+")


def greet(dialogue: Dialogue, leftover: Leftover) -> None:
    """Connect and establish the handshake.

    Raises:
        LinkLostError: the controller does not answer, or not as agreed.
    """
    dialogue.restart()
    if not dialogue.handshake:
        return
    is_open = _finds_open_buffer(dialogue)
    if leftover is Leftover.CLOSE:
        dialogue.blind("CLOSE")
    if _is_agreed(dialogue):
        return  # an assignment might become a line of a download that another client is starting
    if is_open and leftover is Leftover.LEAVE:
        raise LinkLostError("a program buffer is open, and the answers are not as is agreed: abort closes it")
    dialogue.blind("CLOSE")
    dialogue.blind(dialogue.handshake)
    if not _is_agreed(dialogue):
        raise LinkLostError(f"the controller does not keep {dialogue.handshake}")


def _is_agreed(dialogue: Dialogue) -> bool:
    """Whether the controller answers in the form that the conversation expects."""
    names, values = zip(*_HANDSHAKE.findall(dialogue.handshake), strict=True)
    ended = dialogue.run(Command(" ".join(names), Kind.QUERY, dialogue.patience))
    return isinstance(ended, Answer) and ended.lines == values


def _finds_open_buffer(dialogue: Dialogue) -> bool:
    """SIZE is negative while a program buffer is open; the framing of the answer is still unknown."""
    told = dialogue.blind("SIZE")
    if not re.search(r"\d", told):
        raise LinkLostError(f"SIZE: expected a number of words, got {told!r}")
    return bool(_NEGATIVE.search(told))
