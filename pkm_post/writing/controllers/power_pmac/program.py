# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program: strut motion written as a Power PMAC motion program.

Enters: strut motion in mm, mm/s and whole ms. Leaves: the moves with the words and the frame of the Power PMAC. Its
memory is configured in the controller's own project, so the motion is never cut into parts.
"""

from __future__ import annotations

from collections.abc import Sequence

from pkm_post.model import StrutMotion
from pkm_post.writing.controllers.power_pmac.settings import PowerPmacSettings
from pkm_post.writing.controllers.pvt import writer
from pkm_post.writing.controllers.pvt.decimals import plain
from pkm_post.writing.controllers.pvt.settings import APPROACH_RAMP_MS
from pkm_post.writing.controllers.pvt.words import Words

WORDS = Words(comment="//", linear="linear", dwell="dwell", interval="pvt", close="close")


def program_text(motion: StrutMotion, settings: PowerPmacSettings, heading: Sequence[str]) -> str:
    """Write a motion as a motion program; as ``pvt.writer.program_text``."""
    return writer.program_text(motion, settings, WORDS, _opening(settings), heading)


def program_parts(motion: StrutMotion, settings: PowerPmacSettings, heading: Sequence[str]) -> tuple[str, ...]:
    """Write a motion, always as one part."""
    return (program_text(motion, settings, heading),)


def _opening(settings: PowerPmacSettings) -> str:
    speed = plain(settings.approach_speed)
    return (
        f"open prog {settings.program}\nabs\nfrax({','.join(settings.letters)})\n"
        f"linear\nta{APPROACH_RAMP_MS} ts0 F{speed}\n"
    )
