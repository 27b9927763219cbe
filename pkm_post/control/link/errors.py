# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults: the exceptions of communication with a controller.

A refusal carries the controller's number and its meaning. A lost link is a separate case, and a set command with an
unknown outcome is a third: never resend it without querying the state.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pkm_post.model import Diagnostic

ERROR_TEXTS: dict[int, str] = {
    1: "not allowed while a program runs",
    2: "the password is missing",
    3: "not understood, or wrong data",
    4: "illegal character, or a parity or framing error on the line",
    5: "no program buffer is open",
    6: "the buffer has no room",
    7: "another buffer is in use",
    8: "error of the auxiliary communication",
    9: "the structure of the program is wrong",
    10: "a motor is on both of its limits",
    11: "the previous move has not ended",
    12: "a motor is in open loop",
    13: "a motor is not activated",
    14: "the coordinate system has no motors",
    15: "the coordinate system points to no valid program, or a buffer is open",
    16: "the running program is not properly structured",
    17: "motors are not where the program was stopped",
    18: "the phase reference of a motor is missing",
    19: "positions may not be changed while moves are stored",
}
"""Meanings of ERR001 to ERR019."""


def meaning(number: int | None) -> str:
    """An error of the controller in plain text, with its number."""
    if number is None:
        return "an error without a number"
    return f"ERR{number:03d}, {ERROR_TEXTS.get(number, 'which has no known meaning')}"


class PmacError(Exception):
    """Any failure of communication with the controller."""


class RefusedError(PmacError):
    """The controller refused a command and did not execute it.

    Attributes:
        number: of the error, None if the controller gave none.
    """

    def __init__(self, command: str, number: int | None, words: str = "") -> None:
        super().__init__(f"the controller refused {command!r}: {words or meaning(number)}")
        self.command, self.number = command, number


class LinkLostError(PmacError):
    """The link was cut, or the answer was invalid even after retries."""


class TooLongError(LinkLostError):
    """The answer to a query has more bytes than it can have."""


class OutcomeUnknownError(LinkLostError):
    """The link failed after a set command was sent: whether it was executed is unknown."""

    def __init__(self, command: str, why: str) -> None:
        super().__init__(f"whether the controller carried out {command!r} is unknown: {why}")
        self.command = command


class DiagnosedError(PmacError):
    """A problem outside this program that the operator must fix, with its code and its cure."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(str(diagnostic))
        self.diagnostic = diagnostic


class NoControllerError(DiagnosedError, LinkLostError):
    """No controller answers as expected at the port, even after retries."""


class NoAccessError(DiagnosedError):
    """The controller's computer could not prove its identity, or denies this user access: a retry does not help."""


class NotOwnerError(DiagnosedError):
    """Another client owns the machine, or has taken ownership.

    Attributes:
        what: the other client's operation, as in ``owner_record.OPERATIONS``; empty if unknown.
    """

    def __init__(self, diagnostic: Diagnostic, what: str = "") -> None:
        super().__init__(diagnostic)
        self.what = what


class NotReadyError(PmacError):
    """The controller or the machine is not in the required state, so nothing was started.

    Attributes:
        reasons: each unmet condition in plain text.
    """

    def __init__(self, reasons: Sequence[str]) -> None:
        super().__init__("\n".join(reasons))
        self.reasons = tuple(reasons)


class DownloadError(PmacError):
    """A program could not be loaded into the controller.

    Attributes:
        cleared: whether the controller has confirmed that the program number is empty.
    """

    def __init__(self, why: str, cleared: bool) -> None:
        left = (
            "nothing is left under its number"
            if cleared
            else "WHAT IS LEFT OF IT IN THE CONTROLLER IS UNKNOWN: do not run it, download it again"
        )
        super().__init__(f"{why}; {left}")
        self.cleared = cleared


class OverrideError(PmacError):
    """The override is above the one for which the motion is certified; the machine was held.

    Attributes:
        reason: the override and its limit, without the state of the machine.
    """

    def __init__(self, reason: str, held: bool) -> None:
        super().__init__(f"{reason}; the machine is {'held: abort' if held else 'at rest'}")
        self.reason = reason


class StreamError(PmacError):
    """A program could not be streamed to its end.

    Attributes:
        line: of the program, from 1, after which the machine is or comes to rest by itself; 0 before the first
            line.
        cleared: whether the controller has confirmed that its rotary buffer is empty.
    """

    def __init__(self, why: str, line: int, cleared: bool) -> None:
        where = f"after line {line} of the program" if line else "before the first line of the program"
        left = (
            f"it rests {where} at the latest, and nothing is left in the rotary buffer"
            if cleared
            else f"it comes to rest {where} at the latest, BUT WHAT IS LEFT IN ITS ROTARY BUFFER IS UNKNOWN:"
            " do not start it, stream the program again"
        )
        super().__init__(f"{why}; {left}")
        self.line, self.cleared = line, cleared


class CancelledError(PmacError):
    """Cancelled: by the user, or by a stop."""
