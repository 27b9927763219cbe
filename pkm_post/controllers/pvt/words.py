# SPDX-License-Identifier: LGPL-2.1-or-later
"""Words: how one controller of the family spells what all of them say, for the writer.

The reader has its own statement of them: a fault of the writer must not be read as if it were none.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Words:
    """The words of one controller.

    Attributes:
        comment: begins a comment.
        linear: the mode of the approach, which also ends PVT mode.
        dwell: a dwell in ms; one of 0 stands still and stops computing ahead.
        interval: PVT mode with intervals in ms.
        close: ends the program.
    """

    comment: str
    linear: str
    dwell: str
    interval: str
    close: str
