# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts: messages of numerical control and of the player in the user's language and units.

Takes names and texts of ``control``; returns translated text. Refusals of the controller stay untranslated.
"""

from __future__ import annotations

import logging
import math

import FreeCAD

from pkm_post.control.link import Status
from pkm_post.control.numerical_control import BlockDisplay, ControlState, Homing, Interlock
from pkm_post.control.player import PlayResult, PlayState
from pkm_post.freecad_app.core_texts import fault_text, shown
from pkm_post.freecad_app.user_units import in_user_units
from pkm_post.freecad_gui.quantities import length_text, seconds_text, speed_text, time_text
from pkm_post.model import Diagnostic

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

PLAY_PHASES = {
    "runs": QT_TRANSLATE_NOOP("ControlPanel", "runs"),
    "held": QT_TRANSLATE_NOOP("ControlPanel", "held"),
    "rests": QT_TRANSLATE_NOOP("ControlPanel", "rests"),
    "no link": QT_TRANSLATE_NOOP("ControlPanel", "no link: the machine comes to rest on the path"),
    "single block": QT_TRANSLATE_NOOP("ControlPanel", "single block"),
    "override 0": QT_TRANSLATE_NOOP("ControlPanel", "override 0"),
    "hold": QT_TRANSLATE_NOOP("ControlPanel", "hold"),
}
"""Phases and waits of a player; M0, M1 and tools are named as in the program."""


def why_text(why: Interlock) -> str:
    """The text of an interlock."""
    return shown(why.value)


def activity_text(state: ControlState) -> str:
    """The controller's activity in one line, with any fault of the program."""
    status = state.status
    if status is None:
        return translate("ControlPanel", "Nothing was read yet")
    text = translate("ControlPanel", "no program runs")
    if status.running:
        text = why_text(Interlock.HELD if status.held else Interlock.RUNS)
    moves = [] if status.standing else [why_text(Interlock.MOVES)]
    block = [] if state.block is None or state.block.is_over else [_block_text(state.block)]
    override = translate("ControlPanel", "override {:g} %").format(status.override)
    return ", ".join([text, *moves, *block, override, *map(shown, status.system.fault_texts())])


def _block_text(block: BlockDisplay) -> str:
    text = ": ".join(filter(None, (block.operation, block.text)))
    return translate("ControlPanel", "block {} of {} comes next, line {}: {}").format(
        block.number, block.count, block.line, text
    )


def strut_text(status: Status, index: int) -> str:
    """Message for a strut, counted from 0; empty if all is well."""
    return ", ".join(map(shown, status.motors[index].fault_texts()))


def homing_text(homing: Homing) -> str:
    """Progress of a homing."""
    text = shown(homing.phase.value)
    if not homing.missing:
        return text
    missing = translate("ControlPanel", "no home yet: strut {}").format(", ".join(map(str, homing.missing)))
    return f"{text}; {missing}"


def emergency_text(lines: tuple[str, ...]) -> str:
    """Instructions for the operator."""
    return "\n".join(map(shown, lines))


def play_phase_text(state: PlayState) -> str:
    """The phase of the player, or what it waits for."""
    phase = state.waits_for or state.phase
    text = translate("ControlPanel", PLAY_PHASES[phase]) if phase in PLAY_PHASES else phase
    return translate("ControlPanel", "waits: {}").format(text) if state.waits_for else text


def play_text(state: PlayState) -> str:
    """Phase, operation and line of the player."""
    line = translate("ControlPanel", "line {}").format(state.line)
    return ", ".join(filter(None, (play_phase_text(state), state.operation, line)))


def note_text(record: logging.LogRecord) -> str:
    """A log entry of the player."""
    arguments = record.args if isinstance(record.args, tuple) else ()
    texts = (fault_text(each) if isinstance(each, Diagnostic) else shown(each) for each in arguments)
    return str(record.msg) % tuple(texts)


def progress_text(state: PlayState) -> str:
    """Line, feed, time left and operation in one line, after the phase unless it is running."""
    phase = play_phase_text(state) if state.waits_for or state.phase != "runs" else ""
    line = translate("ControlPanel", "line {}").format(state.line)
    feed = translate("ControlPanel", "feed {} ({:.0f} %)").format(speed_text(state.feed), 100 * state.reached)
    left = (
        "" if math.isinf(state.remaining) else translate("ControlPanel", "{} left").format(time_text(state.remaining))
    )
    return ", ".join(filter(None, (phase, line, feed, left, state.operation)))


def speeds_text(state: PlayState) -> str:
    """The distance and time to go, the feed, and the achieved share of it."""
    feed = translate("ControlPanel", "feed {}, {:.0f} % reached").format(speed_text(state.feed), 100 * state.reached)
    left = "-" if math.isinf(state.remaining) else time_text(state.remaining)
    return translate("ControlPanel", "{} and {} to go; {}").format(length_text(state.to_go), left, feed)


def result_texts(result: PlayResult) -> list[tuple[str, bool]]:
    """The result of a play, and the worst of each quantity with its limit; each with whether it is a fault."""
    ended = translate("ControlPanel", "Ended by the operator")
    if result.finished:
        ended = translate("ControlPanel", "Played to the end")
    seconds = translate("ControlPanel", "{} of motion").format(seconds_text(result.log.seconds))
    found = [(f"{ended}: {seconds}", False)]
    if result.stops:
        text = translate("ControlPanel", "It came to rest {} times because the next piece came too late")
        found.append((text.format(result.stops), True))
    at_least, at_most = translate("ControlPanel", "at least"), translate("ControlPanel", "at most")
    for each in result.log.findings:
        if each.unit and each.limit:
            bound = at_least if each.is_least else at_most
            (value, limit), unit = in_user_units((each.value, each.limit), each.unit)
            found.append((f"{shown(each.name)}: {value} {unit}, {bound} {limit}", not each.holds))
    return found
