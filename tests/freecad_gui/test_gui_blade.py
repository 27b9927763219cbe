# SPDX-License-Identifier: LGPL-2.1-or-later
"""What docs/tutorial-blade.md promises of each of its steps is so: from a face to simulated chips.

    PKM_PICTURES=docs/pictures make test ARGS=tests/freecad_gui/test_gui_blade.py

puts the pictures of the page into that folder again, below the root of the repository.
"""

import re
from pathlib import Path

import FreeCAD
import pytest

pytestmark = pytest.mark.slow  # the other tutorial, and each command, are tried in each FreeCAD

PAGE = Path(__file__).parents[2] / "docs" / "tutorial-blade.md"
PICTURE = re.compile(r"\]\(pictures/(blade_\w+\.png)\)")
SNIPPET = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
SMALL = 150_000
"""bytes: of a picture of the page."""


@pytest.fixture(scope="module")
def session(scene):
    made = scene("blade")
    made.keep("blade_*.png")
    return made


def test_the_face_is_the_top_of_a_solid(session):
    found = session["face_is_modelled"]
    assert found["closed"] and found["faces"] == 6
    assert found["volume"] > 0


def test_the_job_has_its_machine_and_its_tool(session):
    found = session["job_is_made"]
    processor, arguments = found["post"]  # Apply of the post panel writes all of its fields
    assert processor == "hexapod_pmac"
    assert {"--machine=example_6tps", "--work-offset=G54"} <= set(arguments.split())
    assert found["gauge length"] == 120


def test_the_face_is_covered_by_passes_of_a_leaning_tool(session):
    found = session["face_is_finished"]
    assert found["valid"] and found["faces"] == [session["face_is_modelled"]["face"]]
    assert found["passes"] > 10
    assert found["tilted"] > 0.1  # the tool axis leans by more than 25 degrees somewhere
    assert found["chosen"] == [4, 35, 1]  # the page names them
    assert 0.0 <= found["gouge"] < 0.05


def test_the_chips_are_what_was_above_the_face_and_the_face_is_whole(session):
    found = session["chips_are_made"]
    assert found["followable"]
    assert found["whole"] > found["middle"] > found["after"]
    # beside the face the cutter takes a rim as well, of the stock that CAM puts a millimetre around the part
    assert 0.99 * found["above"] < found["whole"] - found["after"] < 2 * found["above"]
    assert found["deepest"] < 0.1 * found["step"]
    assert found["gouged"] < 0.001 * found["above"]
    assert len(found["numbers"]) == 3


def test_the_page_shows_the_pictures_of_these_steps(session):
    shown = set(PICTURE.findall(PAGE.read_text(encoding="utf-8")))
    made = {file.name for file in session.folder.glob("blade_*.png")}
    assert shown == made
    assert all((PAGE.parent / "pictures" / name).stat().st_size < SMALL for name in shown)


def test_the_macro_of_the_page_does_the_same(session):
    names = {}
    exec(compile("\n".join(SNIPPET.findall(PAGE.read_text(encoding="utf-8"))), str(PAGE), "exec"), names)
    operation, clicked = names["finish"], session["face_is_finished"]
    assert operation.PassCount == clicked["passes"]
    assert [operation.Lead.Value, operation.ConeLimit.Value, operation.CheckSpacing.Value] == clicked["chosen"]
    assert operation.MaximumGouge == pytest.approx(clicked["gouge"], abs=1e-6)
    for name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)
