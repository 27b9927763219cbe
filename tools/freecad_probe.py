# SPDX-License-Identifier: LGPL-2.1-or-later
"""Print what this FreeCAD is: its version, its Python's, and which of PKM_MODULES it cannot import.

Run by tools/freecad as ``freecadcmd freecad_probe.py``. It has to run in FreeCAD versions that are too
old for the add-on as well, and in their Python, to let the user know that they are too old.
"""

import importlib
import os
import sys

import FreeCAD


def cannot_import(name):
    """Say whether the module is absent or broken; a broken one may raise anything."""
    try:
        importlib.import_module(name)
    except Exception:
        return True
    return False


version = ".".join(FreeCAD.Version()[:3])
python = ".".join(str(number) for number in sys.version_info[:3])
missing = [name for name in os.environ.get("PKM_MODULES", "").split() if cannot_import(name)]
print("pkm-probe:", version, python, *missing)
sys.stdout.flush()
