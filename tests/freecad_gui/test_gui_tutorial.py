# SPDX-License-Identifier: LGPL-2.1-or-later
"""What docs/tutorial.md promises of each of its steps is so: from an empty document to a certified program.

    PKM_PICTURES=docs/pictures make test ARGS=tests/freecad_gui/test_gui_tutorial.py

puts new pictures of the page into that folder, below the root of the repository.
"""

import math
import re
from pathlib import Path

import FreeCAD
import numpy as np
import pytest
from verified_reports import certificates_agree

from pkm_post.machine import machine_named
from pkm_post.posting.verify import verify
from pkm_post.writing import trajectory_file

PAGE = Path(__file__).parents[2] / "docs" / "tutorial.md"
MICRON, MILLIDEGREE = 1e-3, 1e-3
"""mm and degrees: the tolerances of the paper's part."""
ROUNDING = 1e-9
"""mm, rad, mm/s: a field of a panel does not give its number back to the last bit."""
PICTURE = re.compile(r"\]\(pictures/(tutorial_\w+\.png)\)")
SNIPPET = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
PROGRAM = "tapered_column.pmc"
SMALL = 150_000
"""bytes: of a picture of the page."""


@pytest.fixture(scope="module")
def session(scene):
    made = scene("tutorial")
    made.keep("tutorial_*.png")
    return made


def test_the_column_is_an_ellipse_that_becomes_a_circle(session):
    found = session["column_is_modelled"]
    assert found["shapes"] == [[60, 40], [25, 80]]
    # A level section between them has semi-axes that go linearly with the height: Simpson's rule is exact.
    exact = 80 / 6 * math.pi * (60 * 40 + 4 * 42.5 * 32.5 + 25 * 25)
    assert found["volume"] == pytest.approx(exact, rel=1e-6)
    assert sorted(found["sliced"]) == [pytest.approx(exact / 4, rel=1e-6), pytest.approx(exact * 3 / 4, rel=1e-6)]


def test_the_job_has_its_tool_and_its_machine(session):
    found = session["job_is_made"]
    assert found["asked"][-1] in ("Create Job", "New Job")  # FreeCAD 1.0, 1.1
    assert found["post"] == ["hexapod_pmac", "--machine example_6tps --work-offset G54"]
    assert found["gauge length"] == 120
    assert found["speeds"] == [pytest.approx(30.0), pytest.approx(10.0), 12000]  # mm/s inside: 1800 and 600 mm/min
    assert found["tool"] == [1, "Forward", 16]


def test_a_quarter_is_covered_and_three_copies_follow_it(session):
    found, copies = session["quarter_is_covered"], session["the_other_quadrants_are_copies"]
    assert found["valid"] and found["faces"] == [session["column_is_modelled"]["wall"]]
    assert found["chosen"] == ["Zigzag", 20, 59]
    # The longest line up the wall is 87.3 mm: hypot(80, 60 - 25); borders are passes.
    assert found["passes"] == math.ceil(math.hypot(80, 35) / 20) + 1
    assert "full circle" in copies["Quadrant 3"] or "360.00" in copies["Quadrant 3"]


def test_the_machine_reaches_all_of_it_and_plays_it(session):
    machine, reach, motion = (
        session[name] for name in ("machine_stands_around_it", "reach_is_checked", "motion_is_played")
    )
    assert (machine["out of limits"], machine["offset"]) == ([], [0, 0, 150])
    assert reach["reachable"] and reach["checks"] >= 10
    assert motion["followable"] and motion["seconds"] == 20.0 < motion["duration"]


def test_the_program_is_certified(session):
    found = session["program_is_posted"]
    assert found["folder"]
    assert found["verdict"].startswith("Certified")
    assert {f"tapered_column{end}" for end in (".pmc", "-setup.pmc", ".pkmt", "-report.json", "-report.html")} <= set(
        found["files"]
    )
    assert found["certificate"]["holds"]
    worst = {each["what"]: each for each in found["certificate"]["findings"]}
    tip, axis = worst["deviation of the tool tip"], worst["deviation of the tool axis"]
    assert (tip["unit"], axis["unit"]) == ("mm", "degrees")
    assert tip["value"] <= MICRON and axis["value"] <= MILLIDEGREE


def test_the_program_on_disk_is_verified_as_the_page_says(session):
    machine, _ = machine_named("example_6tps")
    _, report, _ = verify(session.folder / PROGRAM, session.folder / "tapered_column.pkmt", machine)
    certificates_agree(report["certificate"], session["program_is_posted"]["certificate"])


def test_the_page_shows_the_pictures_of_these_steps(session):
    shown = set(PICTURE.findall(PAGE.read_text(encoding="utf-8")))
    made = {file.name for file in session.folder.glob("tutorial_*.png")}
    assert shown == made
    assert all((PAGE.parent / "pictures" / name).stat().st_size < SMALL for name in shown)


def test_the_macros_of_the_page_do_the_same(session, tmp_path, monkeypatch):
    source = "\n".join(SNIPPET.findall(PAGE.read_text(encoding="utf-8")))
    monkeypatch.chdir(tmp_path)
    exec(compile(source, str(PAGE), "exec"), {})
    for name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)
    clicked, written = (
        trajectory_file.read((folder / PROGRAM).with_suffix(".pkmt"))[0] for folder in (session.folder, tmp_path)
    )
    assert written.operations == clicked.operations
    for column in ("tip", "axis", "spin", "feed"):
        np.testing.assert_allclose(getattr(written, column), getattr(clicked, column), rtol=0, atol=ROUNDING)
