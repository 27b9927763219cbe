# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posting from the panel in a FreeCAD with a window."""

import shlex

import pytest

DOCK, FRAME = 380, 42
"""Pixels: FreeCAD's task panel, and of it borders and scroll bar."""


@pytest.fixture(scope="module")
def session(scene):
    made = scene("posting")
    made.keep("post_panel.png")
    return made


def test_panel_writes_and_shows_the_certificate(session):
    found = session["posting_shows_the_certificate"]
    assert found["files"] == [
        "gui-manifest.json", "gui-report.html", "gui-report.json", "gui-setup.pmc", "gui.FCStd", "gui.csv", "gui.pkmt",
        "gui.pmc",
    ]  # fmt: skip
    assert found["verdict"].startswith("Certified")
    assert found["findings"] >= 11  # rows of the certificate
    assert found["report"]
    assert found["steps to undo"] == 1
    selected, reported = found["clicked"]
    operation, line = found["where"].split(": ")
    assert selected == ["Custom"] and reported.startswith(f"{operation}, {line}: ")
    assert session.drew("posted.png")


def test_job_keeps_what_was_chosen_and_cam_posts_the_same(session):
    found = session["job_keeps_what_was_chosen"]
    name, text, program = found["kept"]
    assert name == "hexapod_pmac"
    assert {"--tip-tolerance=0.002", "--also=csv", "--work-offset=0,0,250"} <= set(shlex.split(text))
    assert program.endswith("gui.pmc")
    assert found["same"] and found["listed"]
    assert found["again"] == {"text": text, "folder": str(session.folder / "gui")}
    assert found["undone"] == "--work-offset=0,0,250"


def test_panel_fits_a_dock_of_380_pixels_and_shows_no_empty_decimals(session):
    found = session["panel_fits_a_narrow_dock"]
    assert max(found["width"], found["width with a certificate"]) <= DOCK - FRAME
    tip, axis, heading = (text.replace(" ", "") for text in found["shown"])  # FreeCAD 1.0 has a blank before degrees
    assert tip in ("1.00µm", "1.00μm", "0.001mm")
    assert (axis, heading) == ("0.00123°", "12.3456°")
    for option in ("--tip-tolerance=0.001", "--axis-tolerance=0.00123", "--spin=x-in-plane=12.3456"):
        assert option in found["text"].split()


def test_fields_keep_their_numbers_in_every_unit_system_of_freecad(session):
    kept = "--tip-tolerance=0.00137 --axis-tolerance=0.00123 --spin=x-in-plane=12.3456 --work-offset=0.5,-1.25,250"
    found = session["numbers_stay_in_every_unit_system"]
    assert len(found) == 10
    for system, text in found.items():
        assert set(kept.split()) <= set(text.split()), (system, text)


def test_a_refusal_that_a_place_mends_offers_to_look_for_one(session):
    found = session["refusal_that_a_place_mends_offers_one"]
    assert not found["at first"] and found["offered"] and any("K102" in row for row in found["refused"])
    assert found["bar"] and found["stopped"] == "Stopped." and found["panel"] and found["nothing"]
    assert found["offset"] and "600" not in found["offset"] and f"--work-offset={found['offset']}" in found["kept"]
    assert found["verdict"].startswith("Certified") and "place.pmc" in found["files"]


def test_refused_job_is_reported_and_leaves_nothing(session):
    found = session["refused_job_is_reported_and_leaves_nothing"]
    assert found["files"] == ["refused.FCStd"]
    assert "J105" in found["reported"][0]
    selected, reported = found["clicked"]
    assert selected == ["Custom"]
    assert reported.startswith("Cut, 4: G1")


def test_refusal_of_cams_own_command_is_shown_once_and_changes_nothing(session):
    found = session["refusal_of_cams_own_command_is_shown_once"]
    assert found["files"] == ["cam_refused.FCStd"]
    assert len(found["rows"]) == 1 and "J105" in found["rows"][0]
    assert found["verdict"].startswith("Refused")
    assert (found["undo steps"], found["transaction is open"]) == (0, False)
    assert found["clicked"][0] == ["Custom"]
    assert not found["offers a place"] and found["offers a place out of reach"]


def test_lack_of_memory_is_reported_and_leaves_nothing(session):
    found = session["lack_of_memory_is_reported_and_leaves_nothing"]
    assert found["files"] == ["lacking.FCStd"]
    (in_the_window,), (beside_it,) = found["reported"]
    assert "F130" in in_the_window
    assert "in the step reach and feed plan" in beside_it
    (box,) = found["boxes"]
    assert box.startswith("Mirror: error F130: ")


def test_arguments_without_a_meaning_are_reported_and_not_kept(session):
    found = session["arguments_without_a_meaning_are_reported"]
    assert found["files"] == ["meaningless.FCStd"]
    assert "J117" in found["reported"][0]
    assert found["kept"] == "--work-offset=0,0,250"


def test_cancelled_job_leaves_nothing(session):
    found = session["cancelled_job_leaves_nothing"]
    assert found["files"] == ["cancelled.FCStd"]
    assert found["reported"].startswith("Stopped")
    assert (found["could"], found["ended"], found["can"]) == (True, True, False)


def test_editor_asks_in_the_same_fields(session):
    found = session["editor_asks_in_the_same_fields"]
    assert {"lines.pmc", "lines.pkmt"} <= set(found["files"])
    assert "lines.pmc" in found["reported"][0]


def test_preferences_are_what_a_new_job_is_offered_and_nothing_else(session):
    found = session["preferences_are_what_a_new_job_is_offered"]
    assert {"--tip-tolerance=0.001", "--axis-tolerance=0.005", "--spin=y-in-plane=30"} <= set(
        shlex.split(found["offered"]["text"])
    )
    assert found["offered"]["folder"] == str(session.folder / "elsewhere")
    assert found["headless"] == 0.001


def test_preferences_have_a_page(session):
    drawn, labels = session["preferences_have_a_page"]["seen"]
    assert drawn
    assert len(labels) == 1


def test_preferences_are_judged_kept_and_reset(session):
    found = session["preferences_are_judged_kept_and_reset"]
    assert "M101" in found["machine"] and "nosuch" not in found["none"] and not found["file"] and not found["none"]
    assert "J117" in found["number"] and "quotation mark" in found["quote"]
    kept = {"--tip-tolerance=0.002", "--part", "my part.stl", "--machine=beside the document.toml"}
    assert kept <= set(shlex.split(found["cured"]))
    assert found["cured"].count("--tip-tolerance") == 1 and found["every"] == 7
    assert found["left"] == ["", "", 0]


def test_panel_closes_with_its_job(session):
    assert not session["panel_closes_with_its_job"]["open"]


def test_panel_closed_by_another_command_stops_posting(session):
    found = session["panel_closed_by_another_command_stops_posting"]
    assert found == {"running": True, "files": ["closed.FCStd"]}
