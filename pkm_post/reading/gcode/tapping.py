# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tapping: the lead of threads, from the feed and the spindle speed of their cycles.

Input: events, with the hand of each thread in place of its lead, and the feeds of the motions. Output: events with
leads. The feed of a tapping cycle is lead times spindle speed, or with G95 the lead itself [LinuxCNC, G84; Fanuc,
rigid tapping]. Units: mm, mm/s, 1/min.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.model import Array, Event, EventKind, threads
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import word_of
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics
from pkm_post.reading.gcode.motions import Motions
from pkm_post.reading.gcode.tools import modal_word
from pkm_post.reading.threads import without_idle_starts

_DECIMALS = 9
"""Decimals of a lead in mm, to remove rounding of the arithmetic."""
_BY_HAND = {1.0: 840, -1.0: 740}


def with_leads(
    events: tuple[Event, ...], blocks: Blocks, motions: Motions, feed: Array, faults: BlockDiagnostics
) -> tuple[Event, ...]:
    """The events of a program with the leads of its threads, in place of their hands, 1 or -1.

    ``feed``, (n,), is in mm/s; threads without a spindle speed are faults.
    """
    if not threads(events):
        return events
    speed = motions.of_blocks(modal_word(blocks, "S", 0.0))
    found = []
    for event in events:
        if event.kind is EventKind.SPINDLE_AXIS and event.value:
            if not speed[event.row] > 0:
                faults.add("G405", int(motions.block[event.row]), (word_of(_BY_HAND[event.value]), " without S"))
                return events
            lead = round(60 * float(feed[event.row]) / float(speed[event.row]), _DECIMALS)
            event = replace(event, value=event.value * lead)
        found.append(event)
    return without_idle_starts(tuple(found), np.flatnonzero(~np.isnan(feed)))
