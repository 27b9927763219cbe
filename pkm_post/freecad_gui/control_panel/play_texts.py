# SPDX-License-Identifier: LGPL-2.1-or-later
"""Play texts: where a play is and how fast, in the user's language and units; what came of it."""

from __future__ import annotations

import math

import FreeCAD

from pkm_post.control.player import PlayResult, PlayState
from pkm_post.freecad_gui.quantities import length_text, speed_text, time_text

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

PHASES = {
    "runs": QT_TRANSLATE_NOOP("ControlPanel", "runs"),
    "held": QT_TRANSLATE_NOOP("ControlPanel", "held"),
    "rests": QT_TRANSLATE_NOOP("ControlPanel", "rests"),
    "no link": QT_TRANSLATE_NOOP("ControlPanel", "no link: the machine comes to rest on the path"),
    "single block": QT_TRANSLATE_NOOP("ControlPanel", "single block"),
    "override 0": QT_TRANSLATE_NOOP("ControlPanel", "override 0"),
    "hold": QT_TRANSLATE_NOOP("ControlPanel", "hold"),
}
"""Phases of a player, and what it waits for; M0, M1 and tools are named as in the program."""


def placed_text(state: PlayState) -> str:
    """What it does, and in which operation and line."""
    phase = state.waits_for or state.phase
    text = translate("ControlPanel", PHASES[phase]) if phase in PHASES else phase
    if state.waits_for:
        text = translate("ControlPanel", "waits: {}").format(text)
    line = translate("ControlPanel", "line {}").format(state.line)
    return ", ".join(filter(None, (text, state.operation, line)))


def speeds_text(state: PlayState) -> str:
    """The feed of the program, the share of it that is reached, and what is left."""
    feed = translate("ControlPanel", "feed {}, {:.0f} % reached").format(speed_text(state.feed), 100 * state.reached)
    left = "-" if math.isinf(state.remaining) else time_text(state.remaining)
    return translate("ControlPanel", "{}; {} and {} to go").format(feed, length_text(state.to_go), left)


def result_texts(result: PlayResult) -> list[tuple[str, bool]]:
    """What was played, and the worst of each quantity with its limit; each with whether it is a fault."""
    ended = translate("ControlPanel", "Ended by the operator")
    if result.finished:
        ended = translate("ControlPanel", "Played to the end")
    seconds = translate("ControlPanel", "{:.1f} s of motion").format(result.log.seconds)
    found = [(f"{ended}: {seconds}", False)]
    if result.stops:
        text = translate("ControlPanel", "It came to rest {} times because nothing more had come in time")
        found.append((text.format(result.stops), True))
    at_least, at_most = translate("ControlPanel", "at least"), translate("ControlPanel", "at most")
    for each in result.log.findings:
        if each.unit and each.limit:
            bound = at_least if each.is_least else at_most
            found.append((f"{each.name}: {each.value:.6g} {each.unit}, {bound} {each.limit:.6g}", not each.holds))
    return found
