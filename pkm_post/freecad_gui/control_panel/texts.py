# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts: messages of numerical control and of the player in the user's language and units.

Takes names and texts of ``control``; returns translated text. The English matches theirs exactly: a test compares it.
Refusals of the controller stay untranslated.
"""

from __future__ import annotations

import logging
import math

import FreeCAD

from pkm_post.control.link import Bits, Status
from pkm_post.control.numerical_control import BlockDisplay, ControlState, Homing, HomingPhase, Interlock
from pkm_post.control.player import PlayResult, PlayState
from pkm_post.freecad_app.core_texts import fault_text, shown
from pkm_post.freecad_app.user_units import in_user_units
from pkm_post.freecad_gui.quantities import length_text, speed_text, time_text
from pkm_post.model import Diagnostic

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

WHY = {
    Interlock.NOT_CONNECTED: QT_TRANSLATE_NOOP("ControlPanel", "there is no connection"),
    Interlock.NO_ANSWER: QT_TRANSLATE_NOOP("ControlPanel", "the controller does not answer"),
    Interlock.BUSY: QT_TRANSLATE_NOOP("ControlPanel", "another command is being executed"),
    Interlock.NO_JOB: QT_TRANSLATE_NOOP("ControlPanel", "no program was opened"),
    Interlock.NOT_LOADED: QT_TRANSLATE_NOOP("ControlPanel", "the program is not loaded"),
    Interlock.NO_TRAJECTORY: QT_TRANSLATE_NOOP("ControlPanel", "no trajectory was opened"),
    Interlock.PLAYS: QT_TRANSLATE_NOOP("ControlPanel", "a trajectory is played"),
    Interlock.NOT_PLAYING: QT_TRANSLATE_NOOP("ControlPanel", "no trajectory is played"),
    Interlock.NOT_WAITING: QT_TRANSLATE_NOOP("ControlPanel", "the play is not waiting"),
    Interlock.NO_BLOCK: QT_TRANSLATE_NOOP("ControlPanel", "no block comes next"),
    Interlock.NO_STOP: QT_TRANSLATE_NOOP("ControlPanel", "the program has no stop with moves after it"),
    Interlock.RUNS: QT_TRANSLATE_NOOP("ControlPanel", "a program runs"),
    Interlock.HELD: QT_TRANSLATE_NOOP("ControlPanel", "a program is held"),
    Interlock.NOT_HELD: QT_TRANSLATE_NOOP("ControlPanel", "no program is held"),
    Interlock.MOVES: QT_TRANSLATE_NOOP("ControlPanel", "the machine moves"),
    Interlock.NOT_HOMED: QT_TRANSLATE_NOOP("ControlPanel", "not all struts are homed"),
}
PHASES = {
    HomingPhase.SEARCHING: QT_TRANSLATE_NOOP("ControlPanel", "the struts look for their homes"),
    HomingPhase.DONE: QT_TRANSLATE_NOOP("ControlPanel", "all struts have found their homes"),
    HomingPhase.NOTHING: QT_TRANSLATE_NOOP("ControlPanel", "the controller shows no homing"),
    HomingPhase.FAILED: QT_TRANSLATE_NOOP("ControlPanel", "the homing has failed"),
    HomingPhase.LATE: QT_TRANSLATE_NOOP("ControlPanel", "the homing takes too long"),
}
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
MOTOR = {
    "negative_limit": QT_TRANSLATE_NOOP("ControlPanel", "on its lower limit"),
    "positive_limit": QT_TRANSLATE_NOOP("ControlPanel", "on its upper limit"),
    "stopped_on_limit": QT_TRANSLATE_NOOP("ControlPanel", "stopped on a limit"),
    "open_loop": QT_TRANSLATE_NOOP("ControlPanel", "in open loop"),
    "homing": QT_TRANSLATE_NOOP("ControlPanel", "searching its home"),
    "amplifier_fault": QT_TRANSLATE_NOOP("ControlPanel", "amplifier fault"),
    "fatal_following_error": QT_TRANSLATE_NOOP("ControlPanel", "following error too large, switched off"),
    "warning_following_error": QT_TRANSLATE_NOOP("ControlPanel", "following error at its warning limit"),
}
SYSTEM = {
    "runtime_error": QT_TRANSLATE_NOOP("ControlPanel", "the program ended with an error"),
    "amplifier_fault": QT_TRANSLATE_NOOP("ControlPanel", "an amplifier has a fault"),
    "fatal_following_error": QT_TRANSLATE_NOOP("ControlPanel", "a following error was too large"),
    "limit": QT_TRANSLATE_NOOP("ControlPanel", "a limit was met"),
}
EMERGENCY = (
    QT_TRANSLATE_NOOP(
        "ControlPanel",
        "THE LINK TO THE CONTROLLER IS LOST AND THE MACHINE MAY BE MOVING. This computer cannot stop it now.",
    ),
    QT_TRANSLATE_NOOP(
        "ControlPanel",
        "1. If anything looks wrong, press the EMERGENCY STOP of the machine. Do not wait for this computer.",
    ),
    QT_TRANSLATE_NOOP(
        "ControlPanel",
        "2. Keep everybody away from the machine. The program continues in the controller until it ends.",
    ),
    QT_TRANSLATE_NOOP(
        "ControlPanel",
        "3. If the machine has a feed hold of its own, press it, and make sure that all six struts are at rest.",
    ),
    QT_TRANSLATE_NOOP(
        "ControlPanel",
        "4. Then check the cable, the power of the controller, and this computer; leave the machine as it is.",
    ),
    QT_TRANSLATE_NOOP(
        "ControlPanel",
        "5. When the controller answers again: status, then hold, then abort; only then start, resume, jog or load.",
    ),
    QT_TRANSLATE_NOOP(
        "ControlPanel",
        "6. If the power was off or the emergency stop was pressed: home the machine before anything else.",
    ),
    QT_TRANSLATE_NOOP(
        "ControlPanel",
        "7. Bring the tool free of the part by short jogs along its axis, then to the start, before a program runs again.",  # noqa: E501 - one literal, for lupdate
    ),
)


def why_text(why: Interlock) -> str:
    """The text of an interlock."""
    return translate("ControlPanel", WHY[why])


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
    return ", ".join([text, *moves, *block, override, *_texts_of_bits(status.system, SYSTEM)])


def _block_text(block: BlockDisplay) -> str:
    """A block, with the name of its operation in the job."""
    text = ": ".join(filter(None, (block.operation, block.text)))
    return translate("ControlPanel", "block {} of {} comes next, line {}: {}").format(
        block.number, block.count, block.line, text
    )


def strut_text(status: Status, index: int) -> str:
    """Message for a strut, counted from 0; empty if all is well."""
    return ", ".join(_texts_of_bits(status.motors[index], MOTOR))


def homing_text(homing: Homing) -> str:
    """Progress of a homing."""
    text = translate("ControlPanel", PHASES[homing.phase])
    if not homing.missing:
        return text
    missing = translate("ControlPanel", "no home yet: strut {}").format(", ".join(map(str, homing.missing)))
    return f"{text}; {missing}"


def emergency_text(lines: tuple[str, ...]) -> str:
    """Instructions for the operator."""
    return "\n".join(translate("ControlPanel", line) for line in lines)


def _texts_of_bits(bits: Bits, texts: dict[str, str]) -> list[str]:
    return [translate("ControlPanel", texts[name]) for name in bits.FAULT_TEXTS if bits.has(name)]


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
    seconds = translate("ControlPanel", "{:.1f} s of motion").format(result.log.seconds)
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
