# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post hook: registers the post-processors of this add-on with CAM.

Up to FreeCAD 1.1, CAM searches the folders that ``Path.Preferences.searchPathsPost`` lists, and cannot register another
one; that function is extended here. Newer versions provide a call. CAM takes half a second to load, so nothing of it
is imported at startup: the folder is added when CAM itself imports its preferences.
"""

from __future__ import annotations

import os
from types import ModuleType

from pkm_post.freecad_app.import_hook import when_imported

FOLDER = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "postprocessors")
_PREFERENCES = "Path.Preferences"


def install() -> None:
    """Register the post-processors, now if CAM is loaded and otherwise when it is."""
    when_imported(_PREFERENCES, _register)


def _register(preferences: ModuleType) -> None:
    """Add the folder to the search path of CAM, once."""
    search_paths = preferences.searchPathsPost
    if FOLDER in search_paths():
        return
    add_folder = getattr(preferences, "addAddonPostPath", None)
    if add_folder is not None:  # FreeCAD newer than 1.1
        add_folder(FOLDER)
        return

    def searchPathsPost() -> list[str]:
        return [FOLDER, *search_paths()]  # first, to override an outdated copy in the macro folder

    preferences.searchPathsPost = searchPathsPost
