# SPDX-License-Identifier: LGPL-2.1-or-later
"""Preferences: initial values of the post panel for a job that was never posted, and the page to set them.

Adds the page to FreeCAD's preferences. Only the panel reads them: the output depends on the job alone.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtWidgets

translate = FreeCAD.Qt.translate

GROUP = "User parameter:BaseApp/Preferences/Mod/PkmPost"
PAGES = "PKM Post"
"""The group of pages in FreeCAD's preferences."""
_ARGUMENTS, _FOLDER = "Arguments", "Folder"


def default_arguments() -> str:
    """Initial arguments of a job."""
    text: str = FreeCAD.ParamGet(GROUP).GetString(_ARGUMENTS, "")
    return text


def default_folder() -> str:
    """Initial output folder of a job; empty for that of its document."""
    text: str = FreeCAD.ParamGet(GROUP).GetString(_FOLDER, "")
    return text


class PostPreferences:
    """The page, with FreeCAD's interface."""

    def __init__(self, _parent: Any = None) -> None:
        from pkm_post.freecad_gui.post_fields import PostChoices

        self.form = QtWidgets.QWidget()
        self.form.setWindowTitle(translate("PostPreferences", "Posting"))
        self.choices = PostChoices("", "")
        self.choices.folder.setPlaceholderText(translate("PostPreferences", "the folder of the document"))
        text = translate(
            "PostPreferences", "What the post panel shows at first for a job that has no arguments of its own."
        )
        layout = QtWidgets.QVBoxLayout(self.form)
        layout.addWidget(QtWidgets.QLabel(text))
        layout.addWidget(self.choices)
        layout.addStretch(1)

    def loadSettings(self) -> None:
        """Show the stored values."""
        self.choices.show_text(default_arguments())
        self.choices.folder.setText(default_folder())

    def saveSettings(self) -> None:
        """Store the displayed values."""
        group = FreeCAD.ParamGet(GROUP)
        group.SetString(_ARGUMENTS, self.choices.text())
        group.SetString(_FOLDER, self.choices.folder.text())


def install() -> None:
    """Add the page to FreeCAD's preferences, which derive the icon from the group's name."""
    from pkm_post.freecad_gui.icons import ICONS

    FreeCADGui.addIcon(f"preferences-{PAGES.lower().replace(' ', '_')}", str(ICONS / "pkm_post.svg"))
    FreeCADGui.addPreferencePage(PostPreferences, PAGES)
