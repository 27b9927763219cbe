# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numerical control: a simulated machine connected to, homed, jogged, moved by lines of G-code, and seen in 3D."""

import FreeCAD
import FreeCADGui
import numpy as np
from control_machine import idle, messages, newest, press_in_box, read_again, the_panel
from gui import FOLDER, click, main, picture_of_all, press, settle, step, until
from PySide import QtCore, QtGui, QtWidgets


@step
def every_fault_of_both_controllers_has_its_text():
    from pkm_post.control.link.status import MotorBits, PowerMotorBits, PowerSystemBits, Status, SystemBits
    from pkm_post.control.numerical_control.control_state import ControlState
    from pkm_post.freecad_gui.control_panel.texts import activity_text, strut_text

    found = {}
    for motor, system in ((MotorBits, SystemBits), (PowerMotorBits, PowerSystemBits)):
        strut, program = (
            kind(sum(1 << kind.BIT_NUMBERS[name] for name in kind.FAULT_TEXTS)) for kind in (motor, system)
        )
        status = Status((strut,) * 6, program, 100.0, np.zeros(6), np.zeros(6))
        shown = strut_text(status, 0), activity_text(ControlState(status, None)).split("%, ")[1]
        found[system.__name__] = (strut.fault_texts(), program.fault_texts()), shown
    return found


@step
def panel_opens_without_a_connection():
    FreeCADGui.activateWorkbench("PkmPostWorkbench")
    FreeCAD.newDocument("Control")
    press("PKM_Control")
    face = the_panel().panel
    return {
        "activity": face.activity.text(),
        "stops": [button.isEnabled() for button in (face.stops.hold, face.stops.abort, face.stops.resume)],
        "why": face.jog.buttons["X", 1].toolTip().splitlines()[-1],
        "connect": [face.connecting.connect.isEnabled(), face.connecting.leave.isEnabled()],
        "tool": face.connecting.tool_length.length(),
    }


@step
def names_that_are_wrong_are_reported():
    panel = the_panel()
    page = panel.panel.connecting
    page.port.setText("usb:1")
    click(page.connect)
    page.machine.setEditText("no_such_machine")
    click(page.train)
    page.machine.setEditText("example_6tps")
    reported = messages()
    page.port.setText("tcp:127.0.0.1:1")
    click(page.connect)
    until(lambda: not panel.console.waits, 60)
    return {"reported": reported, "refused": messages()[-1], "connected": panel.console.connection is not None}


@step
def a_simulated_machine_is_connected_to_and_homed():
    from pkm_post.control.numerical_control.homing import HomingPhase

    panel = the_panel()
    face = panel.panel
    click(face.connecting.train)
    until(lambda: newest().status is not None)
    until(lambda: face.homing.home.isEnabled())
    found = {
        "training": [face.training.isVisible(), face.training.text()],
        "homes": [face.struts.item(row, 2).text() for row in range(6)],
        "jog": face.jog.buttons["X", 1].isEnabled(),
        "why": face.jog.buttons["X", 1].toolTip().splitlines()[-1],
        "hold": face.stops.hold.isEnabled(),
    }
    refused = press_in_box("Cancel")
    click(face.homing.home)
    found["asked"] = refused
    found["homing before"] = newest().homing is None and not panel.console.has_orders
    face.homing.trigger.setText("#1K")
    click(face.homing.home)
    found["trigger"] = messages()[-1]
    face.homing.trigger.setText("#1HM #2HM #3HM #4HM #5HM #6HM")
    press_in_box("OK")
    click(face.homing.home)
    until(lambda: newest().homing is not None and newest().homing.phase is not HomingPhase.SEARCHING, 60)
    found["homing"] = newest().homing.phase.name
    idle()
    settle()
    found["reported"] = face.homing.status.text()
    found["homed"] = [face.struts.item(row, 2).text() for row in range(6)]
    found["tip"] = list(newest().pose.tip)
    return found


@step
def a_tool_length_is_read_as_in_the_post_panel():
    page, found = the_panel().panel.connecting, {}
    for text in ("100 kg", "12,5 cm", "0", "13 cm", "120"):
        page.tool_length.setText(text)
        page.tool_length.editingFinished.emit()
        idle()
        found[text] = [page.tool_length.text(), page.taken_length]
    return found


@step
def jogs_are_no_longer_than_on_the_command_line():
    jog = the_panel().panel.jog
    before = [jog.step.property("rawValue"), jog.turn.property("rawValue")]
    for field in (jog.step, jog.turn):
        field.setProperty("rawValue", 1e9)
    found = [jog.step.property("rawValue"), jog.turn.property("rawValue")]
    jog.step.setProperty("rawValue", before[0])
    jog.turn.setProperty("rawValue", before[1])
    return {"longest": found}


def _jogged(name, sign=1):
    before = newest().pose
    click(the_panel().panel.jog.buttons[name, sign])
    idle()
    after = newest().pose
    return before, after


@step
def jogs_move_the_tool_by_the_step():
    face = the_panel().panel
    face.jog.step.setProperty("rawValue", 2.0)
    face.jog.speed.setProperty("rawValue", 10.0)
    before, after = _jogged("X")
    found = {"x": list(after.tip - before.tip)}
    before, after = _jogged("Tilt X")
    found["tilt"] = [*(after.tip - before.tip), *after.axis]
    before, after = _jogged("Spin", -1)
    found["spin"] = float(np.degrees(after.spin - before.spin))
    lengths = newest().status.length
    _jogged("strut")
    found["strut"] = list(newest().status.length - lengths)
    _jogged("strut", -1)
    found["x label"] = face.dro.in_machine["X"].text()
    return found


@step
def jog_page_in_inches():
    from pkm_post.freecad_gui.control_panel.motion_pages import JogPage

    FreeCAD.Units.setSchema(3)
    page = JogPage(the_panel().console)
    page.resize(page.minimumSizeHint())
    page.show()
    settle()
    found = {"width": page.width()}
    for name in ("step", "turn", "speed"):
        line = getattr(page, name).findChild(QtWidgets.QLineEdit)
        found[name] = [line.text(), line.width() - line.fontMetrics().horizontalAdvance(line.text())]
    page.close()
    FreeCAD.Units.setSchema(0)
    return found


@step
def a_jog_out_of_reach_sends_nothing():
    panel = the_panel()
    panel.panel.jog.step.setProperty("rawValue", 500.0)
    executed = []
    control = panel.console.connection.worker._control
    before, execute = list(newest().status.commanded), control.execute
    control.execute = lambda plan: executed.append(plan) or execute(plan)
    click(panel.panel.jog.buttons["X", 1])
    idle()
    control.execute = execute
    panel.panel.jog.step.setProperty("rawValue", 2.0)
    moved = float(np.abs(newest().status.commanded - before).max())
    return {"reported": messages()[-2:], "executed": len(executed), "moved": moved}


@step
def a_stop_drops_a_jog_that_is_being_planned():
    panel = the_panel()
    before = newest().status.commanded
    click(panel.panel.jog.buttons["X", 1])
    click(panel.panel.stops.hold)
    idle()
    return {"moved": float(np.abs(newest().status.commanded - before).max()), "running": newest().status.running}


@step
def a_line_is_checked_and_run():
    page = the_panel().panel.mdi
    panel = the_panel()
    panel.panel.pages.setCurrentWidget(page)
    before = list(newest().pose.tip)
    page.line.setText("G1 X0 Y3 F600")
    click(page.check)
    idle()
    found = {"outcome": page.outcome.text(), "checked": list(newest().pose.tip - before)}
    click(page.run)
    idle()
    offset = panel.console.connection.target.machine.work_offsets["G54"]
    found["work"] = list(offset[:3, :3].T @ (newest().pose.tip - offset[:3, 3]))[:2]
    page.line.setText("G1 X1..5")
    click(page.run)
    idle()
    found["refused"] = [messages()[-1], page.outcome.text()]
    page.line.clear()
    event = QtCore.QEvent.Type.KeyPress
    for _ in range(2):
        key = QtGui.QKeyEvent(event, QtCore.Qt.Key.Key_Up, QtCore.Qt.KeyboardModifier.NoModifier)
        QtWidgets.QApplication.sendEvent(page.line, key)
    found["history"] = page.line.text()
    return found


@step
def the_machine_of_the_document_follows():
    from pkm_post.freecad_app.machine_object import create_machine

    obj = create_machine(FreeCAD.ActiveDocument)
    FreeCAD.ActiveDocument.recompute()
    face = the_panel().panel
    tip = tuple(obj.Tip)
    face.follows.setChecked(True)
    read_again()
    scene = obj.ViewObject.Proxy.scene
    begins = scene._platform.matrix.getValue().getValue()
    _jogged("Y")
    read_again()
    settle()
    ends = scene._platform.matrix.getValue().getValue()
    view, player = obj.ViewObject.Proxy, object()
    follower, view.mover = view.mover, player  # as a player takes the machine when it opens, and releases it
    _jogged("Y")
    read_again()
    left = scene._platform.matrix.getValue().getValue() == ends
    view.release(player)
    _jogged("Y")
    read_again()
    settle()
    again = view.scene._platform.matrix.getValue().getValue()[3][1] - begins[3][1]
    face.messages.clear()
    face.pages.setCurrentWidget(face.jog)
    face.jog.step.setProperty("rawValue", 500.0)
    _jogged("X")
    face.jog.step.setProperty("rawValue", 2.0)
    settle()
    picture_of_all("control.png")
    return {
        "checked": face.follows.isChecked(),
        "moved": ends[3][1] - begins[3][1],
        "property": tuple(obj.Tip) == tip,
        "played": view.mover is follower,
        "left to a player": left,
        "moved again": again,
    }


@step
def the_machine_of_the_document_shows_its_own_pose_again():
    (machine,) = [item for item in FreeCAD.ActiveDocument.Objects if hasattr(item, "MachineFile")]
    panel = the_panel()
    panel.close()
    until(lambda: not panel.console.waits, 60)
    return {"open": panel.isVisible(), "played": machine.ViewObject.Proxy.mover is not None}


@step
def a_power_pmac_is_homed_and_jogged_as_well():
    """The same panel with a machine file that names a Power PMAC; its first jog is rehearsed."""
    from pkm_post.control.numerical_control.homing import HomingPhase
    from pkm_post.machine import find_machine

    file = FOLDER / "power.toml"
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    file.write_text(text.replace('kind = "turbo_pmac"', 'kind = "power_pmac"'), encoding="utf-8")
    press("PKM_Control")
    panel = the_panel()
    face = panel.panel
    face.connecting.machine.setEditText(str(file))
    click(face.connecting.train)
    until(lambda: newest().status is not None)
    until(lambda: face.homing.home.isEnabled())
    face.homing.trigger.setText("#1HM #2HM #3HM #4HM #5HM #6HM")
    press_in_box("OK")
    click(face.homing.home)
    until(lambda: newest().homing is not None and newest().homing.phase is not HomingPhase.SEARCHING, 60)
    idle()
    said = []
    session = panel.console.connection.session
    send = session.command
    session.command = lambda text: said.append(text) or send(text)
    face.jog.step.setProperty("rawValue", 2.0)
    face.jog.speed.setProperty("rawValue", 10.0)
    before, after = _jogged("X")
    found = {"x": list(after.tip - before.tip), "starts": [line for line in said if line.endswith("R")]}
    panel.close()
    until(lambda: not panel.console.waits, 60)
    return found


main()
