# SPDX-License-Identifier: LGPL-2.1-or-later
"""Packages are installed where FreeCAD's Addon Manager puts them, for the Python of this FreeCAD."""

import sys
from pathlib import Path as FilePath

import FreeCAD as App

from pkm_post.system import packages


def test_the_folder_is_that_of_the_addon_manager():
    version = f"py{sys.version_info.major}{sys.version_info.minor}"
    assert packages._PLACE.folder == FilePath(App.getUserAppDataDir()) / "AdditionalPythonPackages" / version


def test_the_message_names_the_command_and_a_line_with_this_python():
    cure = packages.cure("lark")
    assert cure.startswith("choose Install packages in the workbench PKM Post, or type: ")
    assert f"--target {packages._PLACE.folder}" in cure or str(packages._PLACE.folder) in cure
    assert packages.python_words()[0].rsplit("/", 1)[-1].startswith("python")
