# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation and its player, from the button."""

import os
import time

import FreeCAD
import FreeCADGui
from gui import FOLDER, answer, main, picture_of_all, player_dock, press, settle, simulate, step, until
from PySide import QtWidgets

ARGUMENTS = "--work-offset={}"


@step
def simulation_from_its_button():
    from cam_jobs import ARC, BELOW, FIVE_AXIS, add_operation, new_job

    document = FreeCAD.newDocument("hexapod")
    job = new_job(document, BELOW)
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", ARGUMENTS.format("0,0,250")
    add_operation(job, ARC, "Arcs")
    add_operation(job, FIVE_AXIS, "Tilted")
    document.UndoMode = 1
    press("PKM_Machine", job)
    simulate(job)
    document.undo()
    settle()
    reported = {
        "undone": document.getObject("Simulation") is None,
        "closed_by_undo": player_dock() is None,
    }
    simulate(job)
    simulate(job)  # one is there now: it is shown
    made = document.getObject("Simulation")
    reported |= {
        "machine": made.Machine.Name,
        "icon": made.ViewObject.Proxy.icon,
        "count": len([item for item in document.Objects if item.Name.startswith("Simulation")]),
        "valid": made.isValid(),
        "duration": made.Duration.getValueAs("s").Value,
        "plays": player_dock().simulation.duration,
    }
    player_dock().close()
    settle()
    made.ViewObject.Proxy.doubleClicked(made.ViewObject)
    settle()
    reported["opened_by_double_click"] = player_dock() is not None
    return reported


@step
def player_plays():
    player = player_dock()
    machine = FreeCAD.getDocument("hexapod").getObject("Machine")
    reported = {"reported": player.controls.text()}
    player.controls.factor.setCurrentText("2x")
    player.toggle()
    end = time.monotonic() + 1.0
    while time.monotonic() < end:
        settle()
    player.toggle()
    reported["played"] = player.seconds
    player.step()
    reported["stepped"] = player.simulation.next_block(reported["played"]) == player.seconds
    player.step_back()
    reported["stepped_back"] = (
        player.simulation.block_before(player.simulation.next_block(reported["played"])) == player.seconds
    )
    arrows = player.lists.tabBar().findChildren(QtWidgets.QToolButton)
    reported["arrows"] = [each.isVisible() for each in arrows if each.isVisible()]
    slider, step_on = player.widget().slider, QtWidgets.QAbstractSlider.SliderAction.SliderPageStepAdd
    slider.setValue(0)
    for _ in range(20):
        slider.triggerAction(step_on)
    reported["paged"] = player.seconds / player.simulation.duration
    slider.setValue(4000)
    reported["scrubbed"] = player.seconds
    tip = player.simulation.pose_at([4.0])[0][0]
    reported["machine_is_there"] = bool(abs(tip[2] + 120 + 80 - _highest(machine)) < 1.0)
    reported["saved"] = picture_of_all("simulation.png")
    return reported


@step
def override_scales_time_and_speeds():
    player = player_dock()
    player.controls.factor.setCurrentText("1x")
    before = player.widget().plot.grab().toImage()
    player.controls.override.setValue(50)
    settle()
    reported = {"pace": player.controls.time_scale(), "curves_change": player.widget().plot.grab().toImage() != before}
    player.controls.override.setValue(200)
    reported["reported"] = player.controls.text()
    reported["limit"] = player.simulation.machine.strut_speed
    reported["greatest"] = float(player.simulation.greatest_speeds.max())
    player.controls.override.setValue(100)
    return reported


@step
def film_is_written():
    player, frames = player_dock(), FOLDER / "frames"
    frames.mkdir()
    player.controls.factor.setCurrentText("10x")
    written = player.recording(2, 320, 240).write_pictures(frames)
    played = player.recording(4, 320, 240).write_animation(FOLDER / "film.png")
    return {"written": written, "pictures": sorted(os.listdir(frames)), "played": played}


@step
def operations_are_clicked():
    player = player_dock()
    player.lists.operations.itemClicked.emit(player.lists.operations.item(1))
    settle()
    return {
        "selected": [item.Label for item in FreeCADGui.Selection.getSelection()],
        "operation": player.simulation.trajectory.place(player.simulation.block_at(player.seconds + 1e-3)).operation,
        "status": FreeCADGui.getMainWindow().statusBar().currentMessage(),
        "lines": [player.lists.operations.item(row).text() for row in range(player.lists.operations.count())],
    }


@step
def player_follows_the_job():
    document, player = FreeCAD.getDocument("hexapod"), player_dock()
    made = document.getObject("Simulation")
    before = player.simulation
    document.getObject("Job").PostProcessorArgs = ARGUMENTS.format("500,0,200")
    document.recompute()
    settle()
    player.go_to(0.0)
    player.advance(1e6)
    reported = {
        "follows": player.simulation is not before and player.simulation is made.Proxy.plan,
        "problem": player.problem.text,
        "stopped_at": player.seconds == player.problem.time,
        "listed": player.lists.problems.count() == made.ProblemCount,
    }
    last = made.ProblemCount - 1
    player.lists.problems.itemClicked.emit(player.lists.problems.item(last))
    settle()
    reported |= {
        "at_its_worst": player.seconds == made.WorstTimes[last],
        "selected": [item.Label for item in FreeCADGui.Selection.getSelection()] == [made.WorstOperations[last]],
        "marked": made.ViewObject.Proxy._root.getNumChildren(),
        "saved": picture_of_all("problems.png"),
    }
    return reported


@step
def cam_simulates_the_same_job():
    opened = []
    player = player_dock()
    player.controls.removal.emit()
    settle()
    opened.append(bool(FreeCADGui.Control.activeDialog()))
    boxes = FreeCADGui.getMainWindow().findChildren(QtWidgets.QComboBox, "comboJobs")
    jobs = [box.currentText() for box in boxes]
    player.controls.removal.emit()  # the panel is taken: this is reported, and nothing else happens
    settle()
    FreeCADGui.Control.closeDialog()
    settle()
    return {"opened": opened, "jobs": jobs}


@step
def nothing_is_left_open():
    document = FreeCAD.getDocument("hexapod")
    machine, job = document.getObject("Machine"), document.getObject("Job")
    job.PostProcessorArgs = ARGUMENTS.format("0,0,250")
    document.recompute()
    player_dock().go_to(4.0)
    player_dock().close()
    settle()
    reported = {"machine_is_back": abs(_highest(machine) - _shown_height(machine)) < 1e-3}
    made = document.getObject("Simulation")
    simulate(made)
    document.removeObject("Machine")
    settle()
    reported["closed_with_its_machine"] = player_dock() is None
    refused = []
    # as after a restart: the plan has gone, and is asked for
    made.Active, made.Proxy.plan, job.PostProcessorArgs = False, None, "--machine no_such_machine"
    answer(refused)
    press("PKM_Simulate", job)
    until(lambda: refused)
    reported |= {"refused": refused, "no_player": player_dock() is None}
    made.Active, job.PostProcessorArgs = True, ARGUMENTS.format("0,0,250")
    document.recompute()
    simulate(job)  # there is no machine now
    FreeCAD.closeDocument("hexapod")
    settle()
    reported["closed_with_its_document"] = player_dock() is None
    return reported


def _highest(machine):
    """The height of the platform in the machine, out of the scene graph."""
    return machine.ViewObject.Proxy.scene._platform.matrix.getValue().getValue()[3][2]


def _shown_height(machine):
    """The same, as the properties of the machine have it; its tool is upright."""
    tip = machine.WorkOffset.multVec(machine.Tip)
    return tip.z + machine.ToolLength.Value + machine.ViewObject.Proxy.scene.machine.spindle_nose


main(are_drawn=True)
