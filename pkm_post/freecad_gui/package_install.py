# SPDX-License-Identifier: LGPL-2.1-or-later
"""Package install: asks which optional packages to install, and from where.

Downloads nothing without the user's consent. The work runs in the background; a message shows the result.
"""

from __future__ import annotations

from pathlib import Path

import FreeCAD
import FreeCADGui
from PySide import QtWidgets

from pkm_post.freecad_app.core_texts import shown
from pkm_post.freecad_gui.background import BackgroundCall
from pkm_post.model import Phrase
from pkm_post.system import packages

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_TITLE = QT_TRANSLATE_NOOP("PackageInstall", "Install packages")
_PURPOSES = {
    "lark": QT_TRANSLATE_NOOP("PackageInstall", "G-code and CL data"),
    "serial": QT_TRANSLATE_NOOP("PackageInstall", "serial lines to a controller"),
    "paramiko": QT_TRANSLATE_NOOP("PackageInstall", "ssh to a Power PMAC"),
    "matplotlib": QT_TRANSLATE_NOOP("PackageInstall", "pictures of reports and reach maps"),
}


class PackageQuestion(QtWidgets.QMessageBox):
    """The missing packages, with a button for each source."""

    def __init__(self, modules: list[str]) -> None:
        super().__init__(FreeCADGui.getMainWindow())
        self.setObjectName("PKM_InstallPackages")
        self.setWindowTitle(translate("PackageInstall", _TITLE))
        self._modules = modules
        purposes = {name: translate("PackageInstall", _PURPOSES[name]) for name in modules}
        rows = [f"{packages.OPTIONAL[name]}: {purpose}" for name, purpose in purposes.items()]
        self.setText(
            "\n".join([translate("PackageInstall", "Missing:"), *rows])
            if rows
            else translate("PackageInstall", "All packages are installed.")
        )
        self._index = self._folder = None
        if rows:
            accept = QtWidgets.QMessageBox.ButtonRole.AcceptRole
            self._index = self.addButton(translate("PackageInstall", "Download and install"), accept)
            self._folder = self.addButton(translate("PackageInstall", "Install from a folder..."), accept)
        self.addButton(QtWidgets.QMessageBox.StandardButton.Close)
        self.finished.connect(self._answered)

    def _answered(self, _result: int) -> None:
        clicked = self.clickedButton()
        if clicked is None or clicked not in (self._index, self._folder):
            return
        folder = None
        if clicked is self._folder:
            chosen = QtWidgets.QFileDialog.getExistingDirectory(self.parent(), self.windowTitle())
            if not chosen:
                return
            folder = Path(chosen)
        begin(self._modules, folder)


def open_question() -> None:
    """Ask which of the missing packages to install."""
    PackageQuestion(packages.missing()).open()


def begin(modules: list[str], folder: Path | None) -> BackgroundCall:
    """Install in the background, and show the result.

    Args:
        modules: keys of ``packages.OPTIONAL``.
        folder: of wheels, instead of the package index.
    """
    window = FreeCADGui.getMainWindow()
    call = BackgroundCall(lambda: packages.install(modules, folder), window)
    call.finished.connect(lambda: _show(call))
    call.start()
    window.statusBar().showMessage(translate("PackageInstall", "Installing packages..."))
    return call


def _show(call: BackgroundCall) -> None:
    window, title = FreeCADGui.getMainWindow(), translate("PackageInstall", _TITLE)
    window.statusBar().clearMessage()
    try:
        call.value()
        QtWidgets.QMessageBox.information(window, title, translate("PackageInstall", "The packages are installed."))
    except packages.NotInstalledError as fault:
        QtWidgets.QMessageBox.warning(window, title, shown(Phrase(fault.pattern, *fault.values)))
    call.deleteLater()
