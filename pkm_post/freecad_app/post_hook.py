# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post hook: CAM finds the post-processors of this add-on where the add-on is installed.

Up to FreeCAD 1.1, CAM looks for post-processors in the folders that ``Path.Preferences.searchPathsPost`` lists, and has
no way to add one; that function is extended here. Newer versions can be told. CAM takes half a second to load, so
nothing of it is imported when FreeCAD starts: the folder is added when CAM itself asks for its preferences.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType

FOLDER = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "postprocessors")
_PREFERENCES = "Path.Preferences"


def install() -> None:
    """Make the post-processors known, now if CAM is loaded and otherwise when it is."""
    loaded = sys.modules.get(_PREFERENCES)
    if loaded is not None:
        _register(loaded)
    elif not any(isinstance(finder, _WhenImported) for finder in sys.meta_path):
        sys.meta_path.insert(0, _WhenImported())


class _WhenImported:
    """Stands before the importers of Python until the preferences of CAM are imported."""

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Find the preferences as Python does, and register the folder as soon as they are executed."""
        if name != _PREFERENCES:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        if spec is not None and spec.loader is not None:
            spec.loader.exec_module = _followed_by_registration(spec.loader.exec_module)
        return spec


def _followed_by_registration(execute: Callable[[ModuleType], None]) -> Callable[[ModuleType], None]:
    def exec_module(module: ModuleType) -> None:
        execute(module)
        _register(module)

    return exec_module


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
