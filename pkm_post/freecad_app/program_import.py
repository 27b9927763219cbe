# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program import: the functions FreeCAD calls when a part program is opened, or dropped on its window.

Takes the name of a file; adds a program object to a new or an open document. ``Init.py`` names this module and the
suffixes.
"""

from __future__ import annotations

import importlib
from pathlib import Path as FilePath
from typing import Any

import FreeCAD as App

from pkm_post.freecad_app.document import transaction
from pkm_post.freecad_app.program_object import create_program
from pkm_post.reading import program_stem


def open(filename: str) -> Any:  # noqa: A001 - FreeCAD wants this name
    """Show a part program in a new document."""
    document = App.newDocument(program_stem(FilePath(filename)))
    insert(filename, document.Name)
    return document


def insert(filename: str, docname: str) -> None:
    """Add a part program to a document, which is created if none has that name."""
    document = App.getDocument(docname) if docname in App.listDocuments() else App.newDocument(docname)
    with transaction(document, f"Import {FilePath(filename).name}"):
        create_program(document, filename)
    if App.GuiUp:
        importlib.import_module("FreeCADGui").SendMsgToActiveView("ViewFit")
