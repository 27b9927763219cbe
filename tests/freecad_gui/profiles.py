# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fresh user folders of FreeCAD: a language and one of the themes that FreeCAD ships, and nothing else."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import FreeCAD

_IS_OLDER = [int(number) for number in FreeCAD.Version()[:2]] < [1, 1]
CHINESE = "Chinese Simplified" if _IS_OLDER else "Chinese (Simplified)"
ENGLISH = "English"
DARK, LIGHT = "FreeCAD Dark", "FreeCAD Light"


def write_profile(folder, language=ENGLISH, theme=None, start_page=True):
    """Write the settings of a user who chose a language and a theme, and changed nothing else.

    Args:
        folder: becomes the value of FREECAD_USER_HOME.
        language: name that FreeCAD has for it.
        theme: name of a preference pack; None for the look of an unthemed FreeCAD.
        start_page: whether FreeCAD shows it; in 1.1 it takes longer than all the rest of the start.
    """
    root = ElementTree.Element("FCParameters")
    if theme is not None:
        packs = Path(FreeCAD.getResourceDir()) / "Gui" / "PreferencePacks"
        root = ElementTree.parse(packs / theme / f"{theme}.cfg").getroot()
    preferences = _group(root, "Root", "BaseApp", "Preferences")
    ElementTree.SubElement(_group(preferences, "General"), "FCText", Name="Language").text = language
    if not start_page:
        ElementTree.SubElement(_group(preferences, "Mod", "Start"), "FCBool", Name="ShowOnStartup", Value="0")
    ElementTree.ElementTree(root).write(Path(folder) / "user.cfg", encoding="utf-8", xml_declaration=True)


def _group(parent, *names):
    """The group of settings at this path of names, made if there is none."""
    for name in names:
        there = [child for child in parent.iterfind("FCParamGroup") if child.get("Name") == name]
        parent = there[0] if there else ElementTree.SubElement(parent, "FCParamGroup", Name=name)
    return parent
