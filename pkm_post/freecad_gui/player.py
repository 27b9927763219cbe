# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player: a dock that plays the planned motion of a simulation object, in real time and faster or slower.

A simulation object enters; the machine moves in the 3D view, with a cursor over the curves of its struts. Only
transforms change from frame to frame. The clock is that of the computer: a frame that comes late is left out, the
motion is not slowed down. When the document is computed anew, what is played is the new plan.
"""

from __future__ import annotations

import time
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.simulated_motion import Problem, Simulation
from pkm_post.freecad_app.simulation_object import plan_of
from pkm_post.freecad_gui.cam_simulator import open_cam_simulator
from pkm_post.freecad_gui.deletion_watch import DeletionWatch
from pkm_post.freecad_gui.film import Film, ask_for_animation, ask_for_pictures
from pkm_post.freecad_gui.job_places import show_place
from pkm_post.freecad_gui.player_content import PlayerContent
from pkm_post.freecad_gui.player_text import told
from pkm_post.freecad_gui.recompute_watch import RecomputeWatch
from pkm_post.freecad_gui.stage import Stage
from pkm_post.model import Place, Refused
from pkm_post.out_of_memory import memory_or_refused

translate = FreeCAD.Qt.translate

_NAME = "PkmPlayer"
_FRAME_MS = 16


class Player(QtWidgets.QDockWidget):
    """The dock.

    Attributes:
        subject: the simulation object.
        controls: the row of buttons.
        lists: problems and operations.
        simulation: its plan.
        seconds: the time that is shown.
        problem: at which the player has stopped, if it has.
    """

    def __init__(self, subject: Any, simulation: Simulation) -> None:
        super().__init__(subject.Label, FreeCADGui.getMainWindow())
        self.setObjectName(_NAME)
        self.subject, self.simulation, self.seconds = subject, simulation, 0.0
        self.problem: Problem | None = None
        self._stage: Stage | None = None
        document, machine = subject.Document.Name, subject.Machine
        self._document = document
        self._watches = [DeletionWatch(self.close, document, item.Name) for item in (subject, machine) if item]
        self._watches.append(RecomputeWatch(self._follow, document))
        self._timer, self._last = QtCore.QTimer(self), 0.0
        self._timer.timeout.connect(self._tick)
        self._content = PlayerContent(simulation)
        self.controls, self.lists = self._content.controls, self._content.lists
        self._connect()
        self.setWidget(self._content)
        self.take(simulation)

    def _connect(self) -> None:
        """Let the user's wishes be done."""
        controls, lists = self.controls, self.lists
        for signal, action in (
            (controls.play, self.toggle),
            (controls.back, self.step_back),
            (controls.forward, self.step),
            (controls.pictures, lambda: ask_for_pictures(self, self.film)),
            (controls.animation, lambda: ask_for_animation(self, self.film, self.subject.Label)),
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
        if self._stage is not None:
            self._stage.strike()
        self._stage = Stage(simulation, self.subject.Document, self.subject.Machine)
        self._content.take(simulation)
        self.go_to(self.seconds)

    def _follow(self) -> None:
        """The document was computed: play what the object holds now, or end where there is nothing."""
        plan = self.subject.Proxy.plan
        if plan is None:
            self.close()
        elif plan is not self.simulation:
            self.take(plan)

    def go_to(self, seconds: float) -> None:
        """Show a time."""
        self.seconds = min(max(seconds, 0.0), self.simulation.duration)
        if self._stage is not None:
            self._stage.show(self.seconds)
        self._content.show_time(self.seconds)
        override = self.controls.override.value() / 100.0
        self.controls.tell(told(self.simulation, self.seconds, self.problem, override))

    def leave_for(self, seconds: float) -> None:
        """Show another time than that of a problem."""
        self.problem = None
        self.go_to(seconds)

    def toggle(self) -> None:
        """Play or pause; at the end, from the beginning."""
        if self._timer.isActive():
            self.pause()
            return
        if self.seconds >= self.simulation.duration:
            self.go_to(0.0)
        self.problem, self._last = None, time.perf_counter()
        self._timer.start(_FRAME_MS)
        self.controls.show_playing(True)

    def pause(self) -> None:
        """Stand still."""
        self._timer.stop()
        self.controls.show_playing(False)

    def step(self) -> None:
        """To the end of the block."""
        self.pause()
        self.leave_for(self.simulation.next_block(self.seconds))

    def step_back(self) -> None:
        """To the beginning of the block."""
        self.pause()
        self.leave_for(self.simulation.block_before(self.seconds))

    def _tick(self) -> None:
        now = time.perf_counter()
        passed, self._last = now - self._last, now
        self.advance(passed * self.controls.pace())

    def advance(self, seconds: float) -> None:
        """Go on by a time of the plan, no further than the next problem if the player stops at them."""
        to = min(self.seconds + seconds, self.simulation.duration)
        stops = self.controls.stops.isChecked()
        self.problem = self.simulation.problem_between(self.seconds, to) if stops else None
        self.go_to(to if self.problem is None else self.problem.time)
        if self.problem is not None or to >= self.simulation.duration:
            self.pause()

    def show_problem(self, number: int) -> None:
        """Where a problem is worst: its time, its operation, and its mark."""
        self.pause()
        self.problem = self.simulation.problems[number]
        self.go_to(self.problem.worst_time)
        self.subject.ViewObject.Proxy.choose(number)
        self._show(self.problem.worst_place)

    def show_operation(self, number: int) -> None:
        """Where an operation begins."""
        self.pause()
        row, begins = self.simulation.operation_begins(number)
        self.leave_for(begins)
        self._show(self.simulation.trajectory.place(row))

    def _show(self, place: Place) -> None:
        show_place(self.subject.Job, place.operation, place.line)

    def film(self, per_second: float, width: int, height: int) -> Film:
        """The motion as pictures, at the speed that is chosen."""
        self.pause()
        return Film(
            view=FreeCADGui.getDocument(self._document).activeView(),
            show=self.go_to,
            now=self.seconds,
            duration=self.simulation.duration,
            pace=self.controls.pace(),
            per_second=per_second,
            width=width,
            height=height,
        )

    def _show_removal(self) -> None:
        self.pause()
        open_cam_simulator(self.subject.Job)

    def closeEvent(self, event: Any) -> None:
        """Give the view back."""
        self.pause()
        for watch in self._watches:
            watch.end()
        self._watches = []
        if self._stage is not None:
            self._stage.strike()
            self._stage = None
        super().closeEvent(event)
        self.deleteLater()


def open_player(subject: Any) -> Player | None:
    """Open the player of a simulation object, or tell why there is none; one that is open is closed."""
    window = FreeCADGui.getMainWindow()
    for open_before in window.findChildren(QtWidgets.QDockWidget, _NAME):
        open_before.close()
    try:
        with memory_or_refused(subject.Label):
            simulation = plan_of(subject)
    except (Refused, ValueError) as fault:
        QtWidgets.QMessageBox.warning(window, translate("PKM_Simulate", "Simulate"), str(fault))
        return None
    player = Player(subject, simulation)
    window.addDockWidget(QtCore.Qt.DockWidgetArea.BottomDockWidgetArea, player)
    return player
