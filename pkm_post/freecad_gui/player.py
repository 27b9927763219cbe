# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player: a dock that plays the planned motion of a simulation object, in real time, faster or slower.

Takes a simulation object; moves the machine in the 3D view, and a cursor over the curves of its struts. Only transforms
change from frame to frame. The player runs on wall-clock time: late frames are dropped, the motion is not slowed down.
After a recompute of the document it plays the new plan.
"""

from __future__ import annotations

import importlib
import time
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.core_texts import exception_text, shown
from pkm_post.freecad_app.simulation import Problem, Simulation
from pkm_post.freecad_app.simulation_object import plan_of, present_plan
from pkm_post.freecad_app.user_units import in_user_units
from pkm_post.freecad_gui.animation import Animation, ask_for_animation, ask_for_pictures
from pkm_post.freecad_gui.job_choices import show_place
from pkm_post.freecad_gui.machine_scene import MovingMachine
from pkm_post.freecad_gui.observers import DeletionWatch, RecomputeWatch, keep_wrappers, view_of
from pkm_post.freecad_gui.player_content import PlayerContent
from pkm_post.freecad_gui.quantities import seconds_text, time_text
from pkm_post.model import Place, Refused
from pkm_post.system import memory_guard


def status_text(simulation: Simulation, seconds: float, problem: Problem | None, override: float) -> str:
    """Return the status line.

    Args:
        seconds: the current time.
        problem: the problem at which the player has stopped, if any.
        override: feed override as a share: 1 is as planned.
    """
    place = simulation.trajectory.place(simulation.block_at(seconds))
    block = translate("PKM_Simulate", "{}, line {}").format(place.operation, place.line)
    more = [shown(each.text) for each in ([problem] if problem else simulation.problems_at(seconds)[:1])]
    return "   ".join([
        f"{seconds_text(seconds, 3)} / {seconds_text(simulation.duration, 3)}",
        block,
        *more,
        *_too_fast(simulation, override),
    ])  # fmt: skip


def caption_text(simulation: Simulation, seconds: float) -> str:
    """Time, operation and line, for a picture."""
    place = simulation.trajectory.place(simulation.block_at(seconds))
    block = translate("PKM_Simulate", "{}, line {}").format(place.operation, place.line)
    return f"{time_text(seconds)} / {time_text(simulation.duration)}   {block}"


def _too_fast(simulation: Simulation, override: float) -> list[str]:
    """The struts that would exceed their speed limit at the chosen override."""
    limit, speeds = simulation.machine.strut_speed, simulation.greatest_speeds * override
    if override <= 1.0 or speeds.max() <= limit:
        return []
    text = translate("PKM_Simulate", "At this override strut {} would have to do {} of {} {}")
    (fastest, allowed), unit = in_user_units((float(speeds.max()), limit), "mm/s")
    return [text.format(int(speeds.argmax()) + 1, fastest, allowed, unit)]


translate = FreeCAD.Qt.translate

_NAME, _CAM_SIMULATOR = "PkmPlayer", "CAM_SimulatorGL"
_FRAME_MS = 16


class PlayerDock(QtWidgets.QDockWidget):
    """The dock.

    Attributes:
        subject: the simulation object.
        seconds: the current time.
        problem: the problem at which the player has stopped, if any.
    """

    def __init__(self, subject: Any, simulation: Simulation) -> None:
        super().__init__(subject.Label, FreeCADGui.getMainWindow())
        self.setObjectName(_NAME)
        self.subject, self.simulation, self.seconds = subject, simulation, 0.0
        self.problem: Problem | None = None
        self._machine: MovingMachine | None = None
        document, machine = subject.Document.Name, subject.Machine
        self._document = document
        self._watches = [DeletionWatch(self.close, document, item.Name) for item in (subject, machine) if item]
        self._watches.append(RecomputeWatch(self._follow, document))
        self._timer, self._last = QtCore.QTimer(self), 0.0
        self._timer.timeout.connect(self._tick)
        self._content = PlayerContent(simulation, subject.Job)
        self.controls, self.lists = self._content.controls, self._content.lists
        self._connect()
        self.setWidget(self._content)
        self.take(simulation)

    def _connect(self) -> None:
        controls, lists = self.controls, self.lists
        for signal, action in (
            (controls.play, self.toggle),
            (controls.back, self.step_back),
            (controls.forward, self.step),
            (controls.pictures, lambda: ask_for_pictures(self, self.recording)),
            (controls.animation, lambda: ask_for_animation(self, self.recording, self.subject.Label)),
            (controls.removal, self._show_removal),
            (controls.overridden, lambda _share: self.go_to(self.seconds)),
            (lists.problem, self.show_problem),
            (lists.operation, self.show_operation),
            (self._content.wanted, self.leave_for),
        ):
            signal.connect(action)

    def take(self, simulation: Simulation) -> None:
        """Play a plan."""
        self.pause()
        self.simulation, self.problem = simulation, None
        if self._machine is not None:
            self._machine.remove()
        self._machine = MovingMachine(simulation, self.subject.Document, self.subject.Machine)
        self._content.take(simulation, self._machine.scene)
        self.go_to(self.seconds)

    def _follow(self) -> None:
        """The document was recomputed: play the object's current plan, or close if there is none."""
        plan = present_plan(self.subject)
        if plan is None:
            self.close()
        elif plan is not self.simulation:
            self.take(plan)

    def go_to(self, seconds: float) -> None:
        """Show the motion at a time."""
        self.seconds = min(max(seconds, 0.0), self.simulation.duration)
        if self._machine is not None:
            self._machine.show(self.seconds, self.problem)
        self._content.show_time(self.seconds)
        override = self.controls.override.value() / 100.0
        self.controls.show_text(status_text(self.simulation, self.seconds, self.problem, override))

    def leave_for(self, seconds: float) -> None:
        """Show a time unrelated to a problem."""
        self.problem = None
        self.go_to(seconds)

    def toggle(self) -> None:
        """Play or pause; at the end, play from the start."""
        if self._timer.isActive():
            self.pause()
            return
        if self.seconds >= self.simulation.duration:
            self.go_to(0.0)
        self.problem, self._last = None, time.perf_counter()
        self._timer.start(_FRAME_MS)
        self.controls.show_playing(True)

    def pause(self) -> None:
        """Pause."""
        self._timer.stop()
        self.controls.show_playing(False)

    def step(self) -> None:
        """Go to the end of the block."""
        self.pause()
        self.leave_for(self.simulation.next_block(self.seconds))

    def step_back(self) -> None:
        """Go to the start of the block."""
        self.pause()
        self.leave_for(self.simulation.block_before(self.seconds))

    def _tick(self) -> None:
        now = time.perf_counter()
        passed, self._last = now - self._last, now
        self.advance(passed * self.controls.time_scale())

    def advance(self, seconds: float) -> None:
        """Advance by a planned time, at most to the next problem if the player stops at problems."""
        to = min(self.seconds + seconds, self.simulation.duration)
        stops = self.controls.stops.isChecked()
        self.problem = self.simulation.problem_between(self.seconds, to) if stops else None
        self.go_to(to if self.problem is None else self.problem.time)
        if self.problem is not None or to >= self.simulation.duration:
            self.pause()

    def show_problem(self, number: int) -> None:
        """Show the worst point of a problem: its time, its operation, and its mark."""
        self.pause()
        self.problem = self.simulation.problems[number]
        self.go_to(self.problem.worst_time)
        self.subject.ViewObject.Proxy.choose(number)
        self._show(self.problem.worst_place)

    def show_operation(self, number: int) -> None:
        """Show the start of an operation."""
        self.pause()
        row, begins = self.simulation.operation_begins(number)
        self.leave_for(begins)
        name, place = self.simulation.trajectory.operations[number], self.simulation.trajectory.place(row)
        self._show(place if place.operation == name else Place("", name))  # it may have no moves

    def _show(self, place: Place) -> None:
        show_place(self.subject.Job, place.operation, place.line)

    def recording(self, per_second: float, width: int, height: int) -> Animation:
        """The motion as pictures, at the current speed."""
        self.pause()
        return Animation(
            view=view_of(self._document),
            show=self._show_finished,
            caption=lambda: caption_text(self.simulation, self.seconds),
            now=self.seconds,
            duration=self.simulation.duration,
            time_scale=self.controls.time_scale(),
            per_second=per_second,
            width=width,
            height=height,
        )

    def _show_finished(self, seconds: float) -> None:
        """Show a time, with the stock cut up to it."""
        self.go_to(seconds)
        self._content.material.finish()

    def _show_removal(self) -> None:
        self.pause()
        open_cam_simulator(self.subject.Job)

    def closeEvent(self, event: Any) -> None:
        """Restore the view."""
        self.pause()
        for watch in self._watches:
            watch.end()
        self._watches = []
        self._content.end()
        if self._machine is not None:
            self._machine.remove()
            self._machine = None
        super().closeEvent(event)
        keep_wrappers(self)
        self.deleteLater()


def open_player(subject: Any) -> PlayerDock | None:
    """Open the player of a simulation object, or report why there is none; an already open player is closed."""
    window = FreeCADGui.getMainWindow()
    for open_before in window.findChildren(QtWidgets.QDockWidget, _NAME):
        open_before.close()
    try:
        with memory_guard(subject.Label):
            simulation = plan_of(subject)
    except (Refused, ValueError) as fault:
        QtWidgets.QMessageBox.warning(window, translate("PKM_Simulate", "Simulate"), exception_text(fault))
        return None
    player = PlayerDock(subject, simulation)
    window.addDockWidget(QtCore.Qt.DockWidgetArea.BottomDockWidgetArea, player)
    FreeCADGui.SendMsgToActiveView("ViewFit")
    return player


def open_cam_simulator(job: Any) -> bool:
    """Open CAM's simulator with a job; return whether it opened. If not, the Report view states why.

    It handles X, Y and Z only, and shows the tool upright.
    """
    importlib.import_module("Path.GuiInit").Startup()  # registers the commands if CAM has not been opened yet
    FreeCAD.setActiveDocument(job.Document.Name)
    if FreeCADGui.Control.activeDialog():
        text = translate("PKM_Simulate", "CAM's simulator needs the task panel: close the open task first")
    elif not FreeCADGui.Command.get(_CAM_SIMULATOR).isActive():
        text = translate("PKM_Simulate", "CAM's simulator does not accept this job")
    else:
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(job)
        FreeCADGui.runCommand(_CAM_SIMULATOR, 0)
        return True
    FreeCAD.Console.PrintUserWarning(text + "\n")
    return False
