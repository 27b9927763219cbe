# SPDX-License-Identifier: LGPL-2.1-or-later
"""A FreeCAD of its own for what a running one cannot show: starting, and opening documents for the first time."""

import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def printed_by(script, *arguments, addon=ROOT):
    """What a script prints in a new FreeCAD with the add-on; the same FreeCAD that this one is."""
    command = [os.environ["FREECADCMD"], "-M", addon, ROOT / "tools" / "run_script.py", "--", script, *arguments]
    run = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=300)
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout
