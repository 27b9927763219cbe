# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the scenes of numerical control share: the panel, a simulated machine in it, waiting, answers, a program."""

import numpy as np
from gui import FOLDER, click, until
from PySide import QtCore, QtWidgets

PER_BLOCK = 100
LINES = ("G1 X2 Y0 Z150 F1200", "X2 Y1", "X0 Y0")
HOME_MM = 1007.8869
"""The struts of the example at home."""


def the_panel():
    from pkm_post.freecad_gui.control_panel import open_control

    return open_control()


def newest():
    return the_panel().console.state


def messages():
    messages = the_panel().panel.messages
    return [messages.item(row).text() for row in range(messages.count())]


def idle():
    """Until no order is under way and the machine stands, as the newest reading says, and the panel shows that."""
    console = the_panel().console

    def is_idle():
        status = console.state.status
        return not console.has_orders and status is not None and status.standing and not status.running

    until(is_idle, 60)
    read_again()  # what was read may be older than the order
    while not is_idle():
        until(is_idle, 60)
        read_again()
    return True


def read_again():
    """Until the state was read twice more, as the first reading may have begun before, and the panel shows it."""
    console, looks = the_panel().console, []
    for _ in range(2):
        before = console.state
        until(lambda before=before: console.state is not before)

    def look():
        looks.append(True)

    console.refreshed.connect(look)
    until(lambda: looks)
    console.refreshed.disconnect(look)


def press_in_box(choice):
    """Press a button of the message box that will open, by its number in the box or as a standard button."""
    asked = []

    def look():
        box = QtWidgets.QApplication.activeModalWidget()
        if not isinstance(box, QtWidgets.QMessageBox):
            QtCore.QTimer.singleShot(50, look)
            return
        asked.append(box.text())
        by_text = {button.text().replace("&", ""): button for button in box.buttons()}
        by_text[choice].click()

    QtCore.QTimer.singleShot(0, look)
    return asked


def program_file(name, *events):
    """All struts out, to rest, back, to rest: one second each."""
    from pkm_post.model import StrutMotion
    from pkm_post.writing.controllers.pmac import program_text

    settings = the_panel().console.connection.target.settings
    share = np.arange(PER_BLOCK + 1) / PER_BLOCK
    out, rate = (1 - np.cos(np.pi * share)) / 2, np.pi / 2 * np.sin(np.pi * share)
    rate[[0, -1]] = 0.0
    length = np.concatenate([out, 1 - out[1:]])[:, None] * np.ones(6) + HOME_MM
    speed = np.concatenate([rate, -rate[1:]])[:, None] * np.ones(6)
    motion = StrutMotion(10 * np.arange(2 * PER_BLOCK + 1), length, speed, events)
    file = FOLDER / name
    file.write_text(program_text(motion, settings, [name]), encoding="ascii")
    return file


def posted_file(name, *lines, **how):
    """A part program that was posted for the machine of the panel; options of ``post_file`` by name."""
    from pkm_post.posting.post_file import post_file

    source = FOLDER / name
    source.write_text("\n".join(("G21 G90 G54", *lines, "M30", "")), encoding="ascii")
    lengths = {0: the_panel().panel.connecting.taken_length}
    return post_file(source, "example_6tps", FOLDER, tool_lengths=lengths, **how).program


def connect_and_home():
    """Make a simulated machine and home it, until it can be jogged."""
    face = the_panel().panel
    click(face.connecting.train)
    until(face.homing.home.isEnabled)
    press_in_box("OK")
    click(face.homing.home)
    return until(face.jog.buttons["Z", 1].isEnabled, 60)
