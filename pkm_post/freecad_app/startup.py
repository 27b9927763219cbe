# SPDX-License-Identifier: LGPL-2.1-or-later
"""Startup: what the add-on registers when FreeCAD starts, without importing CAM, numpy or OpenCASCADE.

The post-processors are registered with CAM, and STEP with the mesh reader, each when its module is imported. Up to
FreeCAD 1.1, CAM searches the folders that ``Path.Preferences.searchPathsPost`` lists, without a call to register
another one; that function is extended here. Newer versions provide a call.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any

FOLDER = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "postprocessors")
MACHINE_FOLDER = os.path.join(FOLDER, "machine")
"""Post-processors for the machines of FreeCAD newer than 1.1; older versions would list them with the others."""
_PREFERENCES = "Path.Preferences"
_SANITY = "Path.Main.Sanity.Sanity"
_MESH_FILE = "pkm_post.reading"
_SYSTEM = "pkm_post.system"

Then = Callable[[ModuleType], None]


def install_post_processors() -> None:
    """Register the post-processors, now if CAM is loaded, otherwise on loading."""
    when_imported(_PREFERENCES, _add_folder)


def install_step_reader() -> None:
    """Let ``mesh_file`` read STEP, now if it is loaded, otherwise on loading."""
    when_imported(_MESH_FILE, _add_step)


def install_package_folder() -> None:
    """Let ``system.packages`` install where FreeCAD looks, now if it is loaded, otherwise on loading."""
    when_imported(_SYSTEM, _use_package_folder)


def install_sanity_checks() -> None:
    """Add our checks to CAM's sanity report, now if it is loaded, otherwise on loading."""
    when_imported(_SANITY, _add_checks)


def _add_checks(sanity: ModuleType) -> None:
    from pkm_post.freecad_app.sanity import add_checks

    add_checks(sanity)


def _use_package_folder(system: ModuleType) -> None:
    """Set the folder that FreeCAD's Addon Manager also uses; a snap has none of its own."""
    import FreeCAD

    if os.environ.get("SNAP_REVISION"):
        return
    version = f"py{sys.version_info.major}{sys.version_info.minor}"
    system.packages.use_folder(Path(FreeCAD.getUserAppDataDir()) / "AdditionalPythonPackages" / version)


def _add_folder(preferences: ModuleType) -> None:
    """Add the folder to the search path of CAM, once."""
    search_paths = preferences.searchPathsPost
    if FOLDER in search_paths():
        return
    add_folder = getattr(preferences, "addAddonPostPath", None)
    if add_folder is not None:  # FreeCAD newer than 1.1
        add_folder(FOLDER)
        add_folder(MACHINE_FOLDER)
        return

    def searchPathsPost() -> list[str]:
        return [FOLDER, *search_paths()]  # first, to override an old copy in the macro folder

    preferences.searchPathsPost = searchPathsPost


def _add_step(reading: ModuleType) -> None:
    reading.MESH_READERS.update(dict.fromkeys(reading.STEP_SUFFIXES, _read_step))


def _read_step(path: Path, name: str) -> Any:
    from pkm_post.freecad_app.mesh import read_step

    return read_step(path, name)


def when_imported(name: str, then: Then) -> None:
    """Call a function with a module: now if it is loaded, otherwise right after its import.

    Args:
        name: full name of the module.
        then: the function; called once per loading. The same function is registered only once.
    """
    loaded = sys.modules.get(name)
    if loaded is not None:
        then(loaded)
    elif not any(isinstance(finder, _Finder) and finder.waits_for(name, then) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder(name, then))


class _Finder:
    """Finder placed before Python's importers until its module is imported.

    Attributes:
        awaited: name of the module.
    """

    def __init__(self, name: str, then: Then) -> None:
        self.awaited, self._then = name, then

    def waits_for(self, name: str, then: Then) -> bool:
        """Whether the finder is for this module and this function."""
        return (self.awaited, self._then) == (name, then)

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Find the module like Python, and call the function after its execution."""
        if name != self.awaited:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        if spec is not None and spec.loader is not None:
            spec.loader.exec_module = self._followed(spec.loader.exec_module)
        return spec

    def _followed(self, execute: Then) -> Then:
        def exec_module(module: ModuleType) -> None:
            execute(module)
            self._then(module)

        return exec_module
