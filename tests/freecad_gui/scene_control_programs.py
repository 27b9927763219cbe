# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numerical control: programs of a simulated machine loaded, held, stepped, aborted; the panel closed, the link cut."""

import FreeCADGui
import numpy as np
from control_machine import (
    HOME_MM,
    LINES,
    PER_BLOCK,
    connect_and_home,
    idle,
    messages,
    newest,
    posted_file,
    press_in_box,
    program_file,
    read_again,
    the_panel,
)
from gui import click, main, picture, press, settle, step, until

LOW = (560, 473)
"""px: what the panel gets of a screen of 1024x640."""


@step
def a_simulated_machine_is_homed():
    press("PKM_Control")
    return {"can jog": connect_and_home()}


@step
def a_program_is_loaded_held_and_resumed():
    panel = the_panel()
    face, console = panel.panel, panel.console
    face.pages.setCurrentWidget(face.program)
    lengths = newest().status.commanded
    before = len(messages())
    face.program.read(program_file("two.pmc"))
    until(lambda: len(messages()) > before and not console.waits)
    not_certified = [messages()[before:], console.job is None, face.program.load.isEnabled()]
    face.program.read(program_file("two.pmc"), uncertified=True)
    until(lambda: console.job is not None and not console.waits)
    settle()
    found = {
        "not certified": not_certified,
        "name": face.program.name.text(),
        "near": float(np.abs(lengths - HOME_MM).max()),
        "start before": face.program.start.isEnabled(),
    }
    click(face.program.load)
    idle()
    found["loaded"], found["bar"] = messages()[-1], face.program.bar.value() == face.program.bar.maximum()
    until(lambda: face.program.start.isEnabled())
    face.stops.override.setValue(40)
    until(lambda: newest().status.override == 40)
    idle()
    found["override"] = newest().status.override
    click(face.program.start)
    until(lambda: newest().status.running)
    jog = face.jog.buttons["X", 1]
    until(lambda: not jog.isEnabled(), 3)  # the panel looks ten times a second
    found["while it runs"] = [newest().status.running, jog.isEnabled(), face.stops.hold.isEnabled()]
    click(face.stops.hold)
    until(lambda: newest().status.held and newest().status.standing)
    read_again()
    settle()
    found["held"] = [face.activity.text(), face.stops.resume.isEnabled(), face.stops.override.isEnabled()]
    found["resumable"] = until(lambda: face.stops.resume.isEnabled())
    click(face.stops.resume)
    until(lambda: newest().status.running and not newest().status.held)
    idle()
    found["ended"] = float(np.abs(newest().status.commanded - HOME_MM).max())
    return found


@step
def it_starts_from_its_start_alone_and_is_brought_there():
    panel = the_panel()
    face, page = panel.panel, panel.panel.program
    face.stops.override.setValue(100)
    until(lambda: newest().status.override == 100)
    idle()
    face.jog.step.setProperty("rawValue", 3.0)
    click(face.jog.buttons["X", 1])
    idle()
    found = {"away": newest().pose.tip.tolist()}
    for name, button in (("refused", page.start), ("approached", page.approach), ("started", page.start)):
        until(lambda button=button: button.isEnabled())
        before = len(messages())
        click(button)
        until(lambda: not panel.console.has_orders)
        settle()
        idle()
        found[name] = messages()[before:]
        found[f"{name} at"] = newest().pose.tip.tolist()
    return found


@step
def it_runs_line_by_line():
    panel = the_panel()
    face, console = panel.panel, panel.console
    page = face.program
    found = {"step before": page.step.isEnabled()}
    before = len(messages())
    click(page.begin_at)  # what was opened was not posted: the lines of its source are unknown
    until(lambda: len(messages()) > before and not console.waits)
    found["refused"] = messages()[before:]
    face.stops.override.setValue(100)
    until(lambda: newest().status.override == 100)
    idle()
    page.read(posted_file("lines.ngc", *LINES))
    until(lambda: page.name.text().startswith("lines.pmc") and not console.waits)
    settle()
    until(lambda: page.begin_at.isEnabled())
    click(page.begin_at)
    until(lambda: newest().block is not None and not console.has_orders)
    settle()
    found["blocks"] = [messages()[-1], str(newest().block)]
    read_again()
    found["activity"] = face.activity.text()
    places = []
    for number in range(2, len(LINES) + 2):
        until(lambda: page.step.isEnabled())
        click(page.step)
        until(lambda number=number: newest().block.number == number)
        idle()
        places.append(newest().pose.tip.tolist())
    settle()
    found["places"], found["step"] = places, page.step.isEnabled()
    return found


def _begin_to_move(sign):
    """Begin a jog of two seconds."""
    panel = the_panel()
    panel.panel.jog.step.setProperty("rawValue", 20.0)
    click(panel.panel.jog.buttons["Z", sign])
    until(lambda: newest().status.running)
    read_again()


@step
def a_program_goes_on_after_its_stop():
    from pkm_post.model import Event, EventKind

    panel = the_panel()
    page, console = panel.panel.program, panel.console
    found = {"without stops": page.go_on.isEnabled()}
    page.read(program_file("stop.pmc", Event(PER_BLOCK, EventKind.STOP, 0.0)), uncertified=True)
    until(lambda: console.stops == 1 and not console.waits)
    settle()
    click(page.load)
    idle()
    until(lambda: page.start.isEnabled())
    out = []
    for button in (page.start, page.go_on):
        until(lambda button=button: button.isEnabled())
        click(button)
        until(lambda: newest().status.running)
        idle()
        out.append(float((newest().status.commanded - HOME_MM).mean()))
    return found | {"out": out, "reported": messages()[-1]}


@step
def an_abort_ends_a_jog():
    panel, before = the_panel(), newest().pose.tip
    _begin_to_move(-1)
    click(panel.panel.stops.abort)
    idle()
    left = 20.0 - float(np.linalg.norm(newest().pose.tip - before))
    return {"left": left, "enabled": until(lambda: panel.panel.jog.buttons["Z", 1].isEnabled())}


@step
def a_window_that_hangs_lets_a_jog_be_held():
    panel = the_panel()
    _begin_to_move(1)
    panel.console._timer.stop()  # what a window that hangs does not do either
    found = {"held": until(lambda: newest().status.held and newest().status.standing, 30)}
    panel.console._timer.start(100)
    read_again()
    found["activity"] = panel.panel.activity.text()
    click(panel.panel.stops.abort)
    idle()
    return found


@step
def it_is_not_closed_beside_a_machine_that_moves():
    panel = the_panel()
    _begin_to_move(1)
    asked = press_in_box("Cancel")
    panel.close()
    found = {"asked": list(asked), "open": panel.isVisible()}
    asked = press_in_box("Cancel")
    FreeCADGui.getMainWindow().close()
    found["window"] = [list(asked), FreeCADGui.getMainWindow().isVisible()]
    idle()
    found["connected"] = panel.console.connection is not None
    return found


@step
def it_holds_the_machine_and_closes_then():
    panel = the_panel()  # to ask for it later would show it again
    _begin_to_move(-1)
    press_in_box("Hold it, then close")
    panel.close()
    found, worker = {"open before": panel.isVisible()}, panel.console.connection.worker
    until(lambda: panel.console.connection is None and not panel.console.waits)
    found["held"], found["open"] = worker.state.status.held, panel.isVisible()  # by what it was closed at
    found["activity"] = panel.panel.activity.text()
    return found


@step
def a_lost_link_shows_what_to_do():
    panel = the_panel()
    face = panel.panel
    connect_and_home()
    _begin_to_move(1)
    panel.console.connection._session._pause = 0.01  # between calls; a second of silence tells nothing new
    panel.console.connection._simulated.close()
    until(lambda: bool(newest().emergency))
    until(lambda: "EMERGENCY STOP" in face.banner.text())
    panel.setFloating(True)
    panel.resize(*LOW)
    until(lambda: (panel.width(), panel.height()) == LOW)
    settle()
    found = {
        "cut off": face.banner.heightForWidth(face.banner.width()) - face.banner.height(),
        "banner": face.banner.text().splitlines(),
        "red": "#cc0000" in face.banner.styleSheet(),
        "jog": face.jog.buttons["X", 1].isEnabled(),
        "hold": face.stops.hold.isEnabled(),
    }
    picture("lost.png")
    panel.setFloating(False)
    press_in_box("Close; the machine continues")
    panel.close()
    until(lambda: not panel.console.waits)
    found["open"] = panel.isVisible()
    found["connected"] = panel.console.connection is not None
    return found


main()
