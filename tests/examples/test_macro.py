# SPDX-License-Identifier: LGPL-2.1-or-later
import runpy
import sys
from pathlib import Path

import FreeCAD as App

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "freecad_app"))

from cam_jobs import FIVE_AXIS, add_operation, new_job  # noqa: E402


def test_macro_posts_beside_the_document(tmp_path):
    document = App.newDocument("part")
    operation = add_operation(new_job(document), FIVE_AXIS)
    operation.Placement.Base = App.Vector(0, 0, 100)  # within the machine's reach
    document.recompute()
    document.saveAs(str(tmp_path / "part.FCStd"))
    try:
        runpy.run_path(str(ROOT / "examples" / "post_first_job.FCMacro"), run_name="__main__")
    finally:
        App.closeDocument(document.Name)
    assert {"part.pmc", "part.pkmt"} <= {path.name for path in tmp_path.iterdir()}
