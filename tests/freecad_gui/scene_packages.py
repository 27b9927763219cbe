# SPDX-License-Identifier: LGPL-2.1-or-later
"""Missing packages in the window: what is offered, and their installation from a folder of wheels."""

import importlib

from gui import FOLDER, answer, click, main, picture, press, settle, step, until
from PySide import QtWidgets
from wheels import NAME, wheel

from pkm_post.freecad_gui import package_install
from pkm_post.system import packages

REPORTED = []


def question():
    """The open question, its text and the texts of its buttons."""
    press("PKM_InstallPackages")
    (box,) = [
        widget
        for widget in QtWidgets.QApplication.topLevelWidgets()
        if widget.objectName() == "PKM_InstallPackages" and widget.isVisible()
    ]
    return box, {"text": box.text(), "buttons": [button.text().replace("&", "") for button in box.buttons()]}


def press_button(box, text):
    """Press a button of the question, and wait for the message that follows."""
    answer(REPORTED)
    click(next(button for button in box.buttons() if button.text().replace("&", "") == text))


def install_from(folder):
    """Choose a folder of wheels in the question; the message that follows."""
    QtWidgets.QFileDialog.getExistingDirectory = lambda *_: str(folder)
    before = len(REPORTED)
    press_button(question()[0], "Install from a folder...")
    until(lambda: len(REPORTED) > before, 60)
    return REPORTED[-1]


@step
def one_is_missing():
    packages.use_folder(FOLDER / "AdditionalPythonPackages")
    packages.OPTIONAL = {"lark": "lark", NAME: NAME}
    package_install._PURPOSES[NAME] = "tests"
    box, found = question()
    found["saved"] = picture("packages.png")
    box.reject()
    settle()
    return found


@step
def a_folder_without_it_is_refused():
    (FOLDER / "empty").mkdir()
    return {"said": install_from(FOLDER / "empty"), "missing": packages.missing()}


@step
def it_is_installed_from_a_folder():
    said = install_from(wheel(FOLDER / "my wheels"))
    module = importlib.import_module(NAME)
    return {"said": said, "file": module.__file__, "missing": packages.missing()}


@step
def nothing_is_missing():
    box, found = question()
    box.reject()
    return found


main()
