# SPDX-License-Identifier: LGPL-2.1-or-later
"""Errors: the numbers with which a PMAC refuses commands, and their meanings [TurboPMAC, PMAC error table].

A refusal is a normal answer of the controller, so it is an exception only inside this package: the port turns it into
``BEL ERRnnn``.
"""

from __future__ import annotations

ERROR_TEXTS = {
    1: "not allowed while a motion program runs",
    2: "password missing",
    3: "data error or unrecognized command",
    4: "illegal character",
    5: "command needs an open program buffer",
    6: "no room in the buffer",
    7: "buffer in use",
    8: "MACRO auxiliary communication",
    9: "structure of the program is wrong",
    10: "both overtravel limits are set",
    11: "a move is not completed",
    12: "a motor is open-loop",
    13: "a motor is not activated",
    14: "no motors in the coordinate system",
    15: "not pointing to a valid program",
    16: "the program is improperly structured",
    17: "motors are not where the program stopped",
    18: "phase reference",
    19: "position changed while moves are stored",
}

RUNNING, PASSWORD, DATA, CHARACTER, NOT_OPEN, NO_ROOM, IN_USE, STRUCTURE = 1, 2, 3, 4, 5, 6, 7, 9
BOTH_LIMITS, MOVING, OPEN_LOOP, NOT_ACTIVATED, NO_MOTORS, NO_PROGRAM, BAD_PROGRAM, DISPLACED = range(10, 18)


class CommandError(Exception):
    """The controller refuses a command.

    Attributes:
        number: of the error, a key of ``ERROR_TEXTS``.
    """

    def __init__(self, number: int) -> None:
        super().__init__(f"ERR{number:03d}: {ERROR_TEXTS[number]}")
        self.number = number
