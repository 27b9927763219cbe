# SPDX-License-Identifier: LGPL-2.1-or-later
"""Words: the spelling of the common commands for one controller of the family, for the writer.

The reader has its own definition, so that it detects a fault of the writer.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Words:
    """The command words of one controller.

    Attributes:
        comment: start of a comment.
        linear: the mode of the approach, which also ends PVT mode.
        dwell: a dwell in ms; a dwell of 0 also stops look-ahead.
        interval: PVT mode with intervals in ms.
        close: ends the program.
    """

    comment: str
    linear: str
    dwell: str
    interval: str
    close: str
