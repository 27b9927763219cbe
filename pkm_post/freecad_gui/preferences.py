# SPDX-License-Identifier: LGPL-2.1-or-later
"""Preferences: initial values of the post panel for a job never posted before, drawing of paths, and their page.

Adds the page to FreeCAD's preferences. Only panels and views read them: the output depends on the job alone.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtWidgets

translate = FreeCAD.Qt.translate

GROUP = "User parameter:BaseApp/Preferences/Mod/PkmPost"
PAGES = "PKM Post"
"""The group of pages in FreeCAD's preferences."""
_ARGUMENTS, _FOLDER, _EVERY = "Arguments", "Folder", "ToolAxisEvery"
_MOST = 100_000
"""Most blocks from one drawn tool axis to the next."""


def default_arguments() -> str:
    """Initial arguments of a job."""
    text: str = FreeCAD.ParamGet(GROUP).GetString(_ARGUMENTS, "")
    return text


def default_folder() -> str:
    """Initial output folder of a job; empty for that of its document."""
    text: str = FreeCAD.ParamGet(GROUP).GetString(_FOLDER, "")
    return text


class _Preference(QtCore.QObject):
    """Emits a changed preference, so that open fields and their drawings follow."""

    changed = QtCore.Signal(int)


_PREFERENCE = _Preference()


class EveryField(QtWidgets.QSpinBox):
    """The preference as a field: blocks from one drawn tool axis to the next; 0 draws none."""

    def __init__(self, keeps: bool = True) -> None:
        """Create the field.

        Args:
            keeps: whether to store a change and show changes made elsewhere; otherwise the owner does.
        """
        super().__init__()
        self.setRange(0, _MOST)
        self.setSpecialValueText(translate("PKM_Simulate", "none"))
        self.setValue(every_nth())
        if keeps:
            _PREFERENCE.changed.connect(self.setValue)
            self.valueChanged.connect(set_every_nth)


def every_nth() -> int:
    """The preference."""
    return int(FreeCAD.ParamGet(GROUP).GetInt(_EVERY, 0))


def set_every_nth(value: int) -> None:
    """Store the preference, and redraw existing axes by it."""
    if value == every_nth():
        return
    FreeCAD.ParamGet(GROUP).SetInt(_EVERY, value)
    _PREFERENCE.changed.emit(value)
    for document in FreeCAD.listDocuments().values():
        for item in document.Objects:
            draw = getattr(getattr(item.ViewObject, "Proxy", None), "show_axes", None)
            if draw is not None:
                draw()


class PostPreferences:
    """The page, with FreeCAD's interface."""

    def __init__(self, _parent: Any = None) -> None:
        from pkm_post.freecad_gui.post_fields import PostChoices
        from pkm_post.freecad_gui.verdict import Verdict

        self.form = QtWidgets.QWidget()
        self.form.setWindowTitle(translate("PostPreferences", "Posting"))
        self.choices = PostChoices("", "")
        self.choices.folder.setPlaceholderText(translate("PostPreferences", "the folder of the document"))
        text = translate("PostPreferences", "Initial values of the post panel for a job without arguments of its own.")
        layout = QtWidgets.QVBoxLayout(self.form)
        layout.addWidget(QtWidgets.QLabel(text))
        layout.addWidget(self.choices)
        self.every = EveryField(keeps=False)
        tip = translate("PostPreferences", "Along paths of five axes, in Reach and in the player")
        self.every.setToolTip(tip)
        axes = QtWidgets.QFormLayout()
        axes.setContentsMargins(self.choices.layout().contentsMargins())  # below its fields
        axes.addRow(translate("PKM_Simulate", "Tool axis every ... blocks"), self.every)
        layout.addLayout(axes)
        self.verdict = Verdict()
        layout.addWidget(self.verdict)
        layout.addStretch(1)
        # FreeCAD stores a page without asking it
        self.choices.changed.connect(lambda: self.verdict.say(self.choices.fault(), holds=False))
        fields = {_ARGUMENTS: self.choices.more, _FOLDER: self.choices.folder, _EVERY: self.every}
        for entry, field in fields.items():  # FreeCAD's Reset clears the entries that its fields name so
            field.setProperty("prefEntry", QtCore.QByteArray(entry.encode()))
            field.setProperty("prefPath", QtCore.QByteArray(b"Mod/PkmPost"))

    def loadSettings(self) -> None:
        """Show the stored values."""
        self.every.setValue(every_nth())
        self.choices.show_text(default_arguments())
        self.choices.folder.setText(default_folder())

    def saveSettings(self) -> None:
        """Store the displayed values."""
        set_every_nth(self.every.value())
        group = FreeCAD.ParamGet(GROUP)
        group.SetString(_ARGUMENTS, self.choices.text())
        group.SetString(_FOLDER, self.choices.folder.text())


def install() -> None:
    """Add the page to FreeCAD's preferences, which derive the icon from the group's name."""
    from pkm_post.freecad_gui.icons import ICONS

    FreeCADGui.addIcon(f"preferences-{PAGES.lower().replace(' ', '_')}", str(ICONS / "pkm_post.svg"))
    FreeCADGui.addPreferencePage(PostPreferences, PAGES)
