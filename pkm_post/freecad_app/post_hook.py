# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post hook: CAM finds the post-processors of this add-on where the add-on is installed.

Up to FreeCAD 1.1, CAM looks for post-processors in the folders that ``Path.Preferences.searchPathsPost`` lists, and has
no way to add one; that function is extended here. Newer versions can be told. CAM takes half a second to load, so
nothing of it is imported when FreeCAD starts: the folder is added when CAM itself asks for its preferences.
"""

from __future__ import annotations

import os
from types import ModuleType

from pkm_post.freecad_app.import_hook import when_imported

FOLDER = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "postprocessors")
_PREFERENCES = "Path.Preferences"


def install() -> None:
    """Make the post-processors known, now if CAM is loaded and otherwise when it is."""
    when_imported(_PREFERENCES, _register)


def _register(preferences: ModuleType) -> None:
    """Add the folder to those that CAM searches, once."""
    search_paths = preferences.searchPathsPost
    if FOLDER in search_paths():
        return
    add_folder = getattr(preferences, "addAddonPostPath", None)
    if add_folder is not None:  # FreeCAD newer than 1.1
        add_folder(FOLDER)
        return

    def searchPathsPost() -> list[str]:
        return [FOLDER, *search_paths()]  # first, so that no old copy in the macro folder is taken

    preferences.searchPathsPost = searchPathsPost
