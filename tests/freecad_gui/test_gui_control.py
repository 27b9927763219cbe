# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of numerical control in a FreeCAD with a window, before a simulated machine over loopback."""

import numpy as np
import pytest

from pkm_post.control.link.stopping import EMERGENCY_STEPS
from pkm_post.options import LONGEST_JOG

NEAR_MM = 1e-4
"""What struts that stand a count of 0.1 um off, and certified to a micron, make of the tip."""
NEAR_DEG = 1e-3


@pytest.fixture(scope="module")
def session(scene):
    made = scene("control")
    made.keep("control.png")
    return made


@pytest.fixture(scope="module")
def programs(scene):
    return scene("control_programs")


def test_every_fault_of_both_controllers_has_its_text(session):
    found = session["every_fault_of_both_controllers_has_its_text"]
    assert found["PowerSystemBits"][0][1][-2:] == ["a lower limit was met", "an upper limit was met"]
    assert all([", ".join(texts) for texts in expected] == list(shown) for expected, shown in found.values())


def test_panel_opens_without_a_connection(session):
    found = session["panel_opens_without_a_connection"]
    assert found["activity"] == "Not connected"
    assert (found["stops"], found["connect"]) == ([False] * 3, [True, False])
    assert found["why"] == "(there is no connection)"
    assert found["tool"] == pytest.approx(120.0)  # of the example at rest


def test_names_that_are_wrong_are_reported(session):
    found = session["names_that_are_wrong_are_reported"]
    port, machine = found["reported"]
    assert port.startswith("port: expected serial:DEVICE") and "M101" in machine
    assert "port 1" in found["refused"] and not found["connected"]


def test_a_simulated_machine_is_homed_after_a_question(session):
    found = session["a_simulated_machine_is_connected_to_and_homed"]
    assert found["training"] == [True, "SIMULATED MACHINE: for training. Nothing real moves."]
    assert (found["homes"], found["homed"]) == (["no"] * 6, ["yes"] * 6)
    assert (found["jog"], found["why"], found["hold"]) == (False, "(not all struts are homed)", True)
    (asked,) = found["asked"]
    assert "#1HM" in asked and found["homing before"]
    assert found["trigger"].startswith("a homing starts with one of ENABLE PLC n")
    assert (found["homing"], found["reported"]) == ("DONE", "all struts have found their homes")
    assert found["tip"] == pytest.approx([0, 0, 300], abs=NEAR_MM)  # home_tip of the example


def test_a_tool_length_is_read_as_in_the_post_panel(session):
    # no length, a comma that is no decimal point, and none above zero leave the length as it is
    assert session["a_tool_length_is_read_as_in_the_post_panel"] == {
        **dict.fromkeys(("100 kg", "12,5 cm", "0"), ["120 mm", 120.0]),
        "13 cm": ["130 mm", 130.0],
        "120": ["120 mm", 120.0],
    }


def test_jogs_are_no_longer_than_on_the_command_line(session):
    step, turn = session["jogs_are_no_longer_than_on_the_command_line"]["longest"]
    assert step <= LONGEST_JOG and turn <= 360


def test_jogs_move_the_tool_by_the_step(session):
    found = session["jogs_move_the_tool_by_the_step"]
    assert found["x"] == pytest.approx([2, 0, 0], abs=NEAR_MM)
    # by one degree about X: sin and cos of it
    assert found["tilt"] == pytest.approx([0, 0, 0, 0, -0.0174524, 0.9998477], abs=NEAR_MM)
    assert found["spin"] == pytest.approx(-1.0, abs=NEAR_DEG)
    assert found["strut"] == pytest.approx([2, 0, 0, 0, 0, 0], abs=NEAR_MM)
    assert found["x label"] == "2.000 mm"


def test_jog_page_in_inches_has_round_steps_with_their_units(session):
    found = session["jog_page_in_inches"]
    assert found["width"] <= 333  # of the page in a panel of 380 pixels
    texts = {name: found[name][0].replace(" ", "") for name in ("step", "turn", "speed")}
    assert texts == {"step": "0.04in", "turn": "1.00°", "speed": "10.00in/min"}
    assert all(found[name][1] > 0 for name in texts)


def test_a_jog_out_of_reach_sends_nothing(session):
    found = session["a_jog_out_of_reach_sends_nothing"]
    assert "C228" in found["reported"][0] and found["reported"][1] == "Not sent: the jog is refused"
    assert (found["executed"], found["moved"]) == (0, 0.0)


def test_a_stop_drops_a_jog_that_is_being_planned(session):
    assert session["a_stop_drops_a_jog_that_is_being_planned"] == {"moved": 0.0, "running": False}


def test_a_line_is_checked_and_run(session):
    found = session["a_line_is_checked_and_run"]
    assert found["outcome"].startswith("To X 0.000 mm, Y 3.000 mm, Z 300.000 mm")
    assert found["checked"] == [0, 0, 0]
    assert found["work"] == pytest.approx([0, 3], abs=NEAR_MM)
    assert "G102" in found["refused"][0] and found["refused"][1] == "Refused; nothing was sent"
    assert found["history"] == "G1 X0 Y3 F600"


def test_the_machine_of_the_document_follows(session):
    found = session["the_machine_of_the_document_follows"]
    assert found["checked"] and found["played"] and found["property"]
    assert found["moved"] == pytest.approx(2.0, abs=1e-3)  # scenes are drawn in single precision
    assert found["left to a player"] and found["moved again"] == pytest.approx(6.0, abs=1e-3)
    assert session.drew("control.png")


def test_the_machine_of_the_document_shows_its_own_pose_again(session):
    assert session["the_machine_of_the_document_shows_its_own_pose_again"] == {"open": False, "played": False}


def test_a_program_is_loaded_held_and_resumed(programs):
    found = programs["a_program_is_loaded_held_and_resumed"]
    reported, no_job, can_load = found["not certified"]
    assert "error C110" in "".join(reported) and no_job and not can_load
    assert (found["name"], found["start before"]) == ("two.pmc, 2.0 s", False)
    assert found["loaded"].startswith("Program 10:") and found["loaded"].endswith("listed back as sent")
    assert found["bar"] and found["override"] == 40.0
    assert found["while it runs"] == [True, False, True]
    assert found["held"] == ["a program is held, override 0 %", True, False] and found["resumable"]
    assert found["ended"] == pytest.approx(0.0, abs=NEAR_MM)


def test_a_program_starts_from_its_start_alone_and_the_tool_is_brought_there(programs):
    found = programs["it_starts_from_its_start_alone_and_is_brought_there"]
    assert found["away"] == pytest.approx([3, 0, 300], abs=10 * NEAR_MM)
    assert "the tool is away from the start of the program: tip 3.000 mm" in "".join(found["refused"])
    assert found["refused at"] == pytest.approx([3, 0, 300], abs=10 * NEAR_MM)
    assert found["approached"] == [] and found["approached at"] == pytest.approx([0, 0, 300], abs=10 * NEAR_MM)
    assert found["started"] == [] and found["started at"] == pytest.approx([0, 0, 300], abs=10 * NEAR_MM)


def test_it_runs_line_by_line(programs):
    found = programs["it_runs_line_by_line"]
    assert "C205" in "".join(found["refused"])
    first = "block 1 of 3, line 2: G1 X2 Y0 Z150 F1200"
    assert found["blocks"] == ["The program has 3 blocks; block 1 comes next", first]
    assert "block 1 of 3 comes next, line 2: G1 X2 Y0 Z150 F1200" in found["activity"]
    places = np.array([[2, 0, 300], [2, 1, 300], [0, 0, 300]])
    assert found["places"] == pytest.approx(places, abs=10 * NEAR_MM)
    assert (found["step before"], found["step"]) == (False, False)


def test_a_program_goes_on_after_its_stop(programs):
    found = programs["a_program_goes_on_after_its_stop"]
    assert not found["without stops"]
    assert found["out"] == pytest.approx([1.0, 0.0], abs=NEAR_MM)


def test_a_power_pmac_is_homed_and_jogged_as_well(session):
    found = session["a_power_pmac_is_homed_and_jogged_as_well"]
    assert found["x"] == pytest.approx([2, 0, 0], abs=NEAR_MM)
    assert found["starts"] == ["&1B999R"] * 2  # the rehearsal and the jog


def test_an_abort_ends_a_jog(programs):
    found = programs["an_abort_ends_a_jog"]
    assert found["enabled"] and found["left"] > 1.0  # of 20 mm, which take two seconds


def test_a_window_that_hangs_lets_a_jog_be_held(programs):
    found = programs["a_window_that_hangs_lets_a_jog_be_held"]
    assert found["held"] and "a program is held" in found["activity"]


def test_it_is_not_closed_beside_a_machine_that_moves(programs):
    found = programs["it_is_not_closed_beside_a_machine_that_moves"]
    question = "The machine moves, or may move. Hold it, or let it continue?"
    assert (found["asked"], found["open"], found["connected"]) == ([question], True, True)
    assert found["window"] == [[question], True]


def test_it_holds_the_machine_and_closes_then(programs):
    found = programs["it_holds_the_machine_and_closes_then"]
    assert found == {"open before": True, "held": True, "open": False, "activity": "Not connected"}


def test_a_lost_link_shows_what_to_do(programs):
    found = programs["a_lost_link_shows_what_to_do"]
    assert found["banner"][: len(EMERGENCY_STEPS)] == list(EMERGENCY_STEPS)
    assert found["banner"][-1].startswith("No link: ")
    assert (found["red"], found["jog"], found["hold"]) == (True, False, True)
    assert found["cut off"] <= 0  # px, on a screen of 1024x640
    assert (found["open"], found["connected"]) == (False, False)
    assert programs.drew("lost.png")
