# SPDX-License-Identifier: LGPL-2.1-or-later
import json
import runpy
import sys
from pathlib import Path

import FreeCAD as App
import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "freecad_app"))

from cam_jobs import FIVE_AXIS, add_operation, new_job  # noqa: E402


@pytest.fixture
def run(tmp_path):
    """Runs a macro with a saved job; the folder of the document."""
    document = App.newDocument("part")
    operation = add_operation(new_job(document), FIVE_AXIS)
    operation.Placement.Base = App.Vector(0, 0, 100)  # within the machine's reach
    document.recompute()
    document.saveAs(str(tmp_path / "part.FCStd"))

    def of_name(name):
        runpy.run_path(str(ROOT / "examples" / name), run_name="__main__")
        return tmp_path

    yield of_name
    App.closeDocument(document.Name)


def names_in(folder):
    return {path.name for path in folder.iterdir()}


def test_macro_posts_beside_the_document(run):
    assert {"part.pmc", "part.pkmt"} <= names_in(run("post_first_job.py"))


def test_macro_posts_a_folder_and_goes_on_behind_what_is_refused(run, tmp_path):
    empty = App.newDocument("empty")
    empty.saveAs(str(tmp_path / "empty.FCStd"))
    App.closeDocument(empty.Name)
    App.setActiveDocument("part")
    folder = run("post_folder.py")
    assert {"part.pmc", "part.pkmt"} <= names_in(folder / "posted")
    assert set(App.listDocuments()) == {"part"}


def test_macro_posts_for_another_machine(run):
    slow = run("post_to_another_machine.py") / "another_machine"
    assert {"careful.toml", "part.pmc", "part.csv"} <= names_in(slow)
    report = json.loads((slow / "part-report.json").read_text())
    assert report["tolerances"]["tip_mm"] == 0.002
    fast = json.loads((run("post_first_job.py") / "part-report.json").read_text())
    assert report["motion"]["duration_s"] > fast["motion"]["duration_s"]
