# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tips, shortcuts and the menus of objects in a FreeCAD with a window."""

import pytest

COPIES = ["Mirror operation", "Rotate operation"]


@pytest.fixture(scope="module")
def session(scene):
    return scene("habits")


def test_every_command_says_what_it_does(session):
    commands = session["commands_have_tips_and_keys"]["commands"]
    assert len(commands) > 8
    for reported in commands.values():
        assert len(reported["status"]) > 20
        assert reported["status"] in reported["tip"]


def test_every_command_has_keys_of_its_own(session):
    found = session["commands_have_tips_and_keys"]
    keys = [reported["keys"] for reported in found["commands"].values()]
    assert all(key.startswith("P,K,") for key in keys)
    assert len(set(keys)) == len(keys)
    # another command with the beginning of these keys would make both ambiguous
    beginnings = {key[:length] for key in keys for length in (1, 3, len(key))}
    assert beginnings.isdisjoint(found["others"])


def test_operations_have_menus(session):
    found = session["operations_have_menus"]
    assert found["mirror"] == found["rotation"] == ["Edit", "Active", *COPIES]
    assert found["finish"] == ["Edit", "Active", *COPIES]
    assert found["compensation"] == ["Active", *COPIES]
    assert found["edited"]


def test_menu_switches_an_operation_off_in_one_step(session):
    on, off, again = session["menu_switches_an_operation_off"]
    assert on[:2] == again[:2] == [True, True]
    assert off[:2] == [False, False]
    assert off[2] < on[2] == again[2]


def test_objects_of_a_job_have_menus(session):
    found = session["objects_of_a_job_have_menus"]
    assert found["machine"] == ["Jog", "Move it home", "Reach", "Simulate", "Post to a hexapod"]
    assert found["alone"] == ["Jog", "Move it home"]
    assert found["reach"] == ["Open the findings", "Active", "Simulate", "Post to a hexapod"]
    assert found["simulation"] == ["Open the player", "Active", "Reach", "Post to a hexapod"]
    assert found["findings"]
    assert found["plays"] == ["Simulation"]


def test_machine_is_moved_home_in_one_step(session):
    found = session["machine_is_moved_home"]
    assert found["moved"] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert found["undone"] == pytest.approx([525.0**0.5, 7.0], abs=1e-9)


def test_program_has_a_menu(session):
    found = session["program_has_a_menu"]
    assert found["texts"] == ["Open in the editor", "Decode into a job", "Post program"]
    assert found["opened"] == ["program.ngc"]
    assert found["after"] == found["before"] + 1


def test_command_of_a_menu_takes_its_object(session):
    found = session["command_of_a_menu_takes_its_object"]
    assert found["base"] == found["rotation"]


def test_panel_closed_by_a_command_leaves_nothing_open(session):
    found = session["panels_are_closed_by_a_command"]
    steps = {"mirror": "Edit symmetric operation", "machine": "Jog the machine", "reach": "Colour by a check"}
    for name, step in steps.items():
        before, after, undo = found[name]
        assert before[:2] == [True, True], name
        assert after == [False, False, False], name
        assert undo == step
    assert found["at its own pose"]


def test_page_of_surface_finish_closed_by_a_command_follows_nothing(session):
    assert session["surface_finish_is_closed_by_a_command"]["open"]


def test_mirror_waits_for_the_panel_of_another_command(session):
    found = session["mirror_beside_an_open_panel"]
    assert found["said"] == ["Another task panel is open: close it first."]
    assert found["made"] == 0
    assert found["state"] == [True, False, False]


def test_cancelled_mirror_leaves_the_one_before(session):
    assert session["mirror_beside_an_open_panel"]["left"] == [True, False]


def test_panel_of_a_job_leaves_no_transaction_open(session):
    found = session["panels_of_a_job_leave_no_transaction"]
    assert found == {"PKM_Post": [True, True], "PKM_Stiffness": [True, True]}


def test_editor_and_control_panel_open_beside_a_task_panel(session):
    assert session["windows_open_beside_a_panel"] == {"PKM_Editor": True, "PKM_Control": True, "PKM_Example": False}


def test_work_offset_with_a_mistake_is_refused_by_the_panel_and_kept_once_mended(session):
    found = session["arguments_beside_a_mistake_are_kept"]
    assert found["refused"] == ["J117"]
    assert found["kept"] == [0.0, 0.0, 250.0]
    assert found["fields"] == ["0,0,250", "--surface-speed=100"]
    assert found["job"]


def test_an_undo_leaves_a_panel_a_step_of_its_own(session):
    found = session["an_undo_leaves_a_panel_a_step_of_its_own"]
    assert (found["fields"], found["cancelled"]) == ([1, 1, True], [1, True])
    assert (found["jog"], found["jog cancelled"]) == ([True, "Jog the machine"], True)
    assert found["deleted"] == [True, False]


def test_a_command_leaves_a_panel_a_step_of_its_own(session):
    found = session["a_command_leaves_a_panel_a_step_of_its_own"]
    assert found["changed"]
    assert found["cancelled"] == [True, [False, False, False]]
    assert found["jog"] == [["Jog the machine", "Reach", "Machine"], [False, False, False]]


def test_simulate_in_the_post_panel_is_for_its_own_document(session):
    found = session["simulate_in_the_panel_of_another_document"]
    assert found == {"simulated": [True, False], "in front": True}


def test_player_moves_the_machine_beside_a_panel_that_shows_a_finding(session):
    found = session["player_beside_a_panel_that_shows_a_finding"]
    assert found == dict.fromkeys(("posed", "panel", "panel closed", "player", "player closed"), True)


def test_commands_draw_in_the_3d_view_while_a_sheet_is_active(session):
    found = session["commands_draw_while_a_sheet_is_active"]
    assert found == {"3D": False, "stiffness": 1, "closed": 0, "simulation": True, "left": 0}


def test_surface_finish_without_a_tool_is_refused_in_a_window(session):
    found = session["finish_without_a_tool"]
    (said,) = found["said"]
    assert "J112" in said
    assert (found["made"], found["state"]) == (0, [False, False, False])


def test_surface_finish_of_a_macro_keeps_its_faces_when_its_panel_opens_and_is_left(session):
    found = session["finish_of_a_macro_is_opened"]
    assert found == {"faces": [["Face6"]], "left": [["Face6"]], "there": True}
