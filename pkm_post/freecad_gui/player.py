# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player: a dock that plays the planned motion of a job, in real time and faster or slower.

A simulation enters; the machine moves in the 3D view, with a cursor over the curves of its struts. Only transforms
change from frame to frame. The clock is that of the computer: a frame that comes late is left out, the motion is not
slowed down.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.simulation import Problem, Simulation
from pkm_post.freecad_gui.deletion_watch import DeletionWatch
from pkm_post.freecad_gui.stage import Stage
from pkm_post.freecad_gui.strut_plot import StrutPlot

translate = FreeCAD.Qt.translate

_CONTEXT, _NAME = "PKM_Simulate", "PkmPlayer"
FACTORS = ("0.1", "0.25", "0.5", "1", "2", "5", "10", "50", "100")
_FRAME_MS = 16
_PER_SECOND = 1000
"""Steps of the slider, as many as the motion has milliseconds."""


class Player(QtWidgets.QDockWidget):
    """The dock.

    Attributes:
        seconds: the time that is shown.
        problem: at which the player has stopped, if it has.
    """

    def __init__(self, simulation: Simulation, document: Any, machine_object: Any = None) -> None:
        super().__init__(translate(_CONTEXT, "Simulation"), FreeCADGui.getMainWindow())
        self.setObjectName(_NAME)
        self.simulation, self.seconds = simulation, 0.0
        self.problem: Problem | None = None
        self.stage = Stage(simulation, document, machine_object)
        self._document = document.Name
        self._watch = DeletionWatch(self.close, document.Name, machine_object and machine_object.Name)
        self._timer, self._last = QtCore.QTimer(self), 0.0
        self._timer.timeout.connect(self._tick)
        self.setWidget(self._content())
        self.go_to(0.0)

    def _content(self) -> QtWidgets.QWidget:
        """Buttons, slider and curves."""
        content, buttons = QtWidgets.QWidget(), QtWidgets.QHBoxLayout()
        self.button = _button(buttons, "SP_MediaPlay", translate(_CONTEXT, "Play and pause"), self.toggle)
        back, on = translate(_CONTEXT, "To the beginning of the block"), translate(_CONTEXT, "To the end of the block")
        _button(buttons, "SP_MediaSkipBackward", back, self.step_back)
        _button(buttons, "SP_MediaSkipForward", on, self.step)
        self.factor = QtWidgets.QComboBox()
        self.factor.addItems([f"{factor}x" for factor in FACTORS])
        self.factor.setCurrentText("1x")
        self.factor.setToolTip(translate(_CONTEXT, "How many times as fast as the machine"))
        buttons.addWidget(self.factor)
        self.stops = QtWidgets.QCheckBox(translate(_CONTEXT, "Stop at problems"))
        self.stops.setChecked(True)
        buttons.addWidget(self.stops)
        _button(buttons, "SP_DialogSaveButton", translate(_CONTEXT, "Write the frames as pictures"), self._ask)
        self.told = QtWidgets.QLabel()
        buttons.addWidget(self.told, 1)
        self.slider = QtWidgets.QSlider(QtCore.Qt.Orientation.Horizontal)
        self.slider.setRange(0, round(self.simulation.duration * _PER_SECOND))
        self.slider.valueChanged.connect(lambda value: self.go_to(value / _PER_SECOND))
        self.plot = StrutPlot(self.simulation, self.go_to)
        layout = QtWidgets.QVBoxLayout(content)
        layout.addLayout(buttons)
        layout.addWidget(self.slider)
        layout.addWidget(self.plot, 1)
        return content

    def go_to(self, seconds: float) -> None:
        """Show a time."""
        self.seconds = min(max(seconds, 0.0), self.simulation.duration)
        self.stage.show(self.seconds)
        self.plot.show_time(self.seconds)
        self.slider.blockSignals(True)
        self.slider.setValue(round(self.seconds * _PER_SECOND))
        self.slider.blockSignals(False)
        place = self.simulation.trajectory.place(self.simulation.block_at(self.seconds))
        problem = "" if self.problem is None else f"   {self.problem.text}"
        shown = f"{self.seconds:.3f} s / {self.simulation.duration:.3f} s   {place.operation}, line {place.line}"
        self.told.setText(shown + problem)

    def toggle(self) -> None:
        """Play or pause; at the end, from the beginning."""
        if self._timer.isActive():
            self.pause()
            return
        if self.seconds >= self.simulation.duration:
            self.go_to(0.0)
        self.problem, self._last = None, time.perf_counter()
        self._timer.start(_FRAME_MS)
        self.button.setIcon(_icon("SP_MediaPause"))

    def pause(self) -> None:
        """Stand still."""
        self._timer.stop()
        self.button.setIcon(_icon("SP_MediaPlay"))

    def step(self) -> None:
        """To the end of the block."""
        self.pause()
        self.go_to(self.simulation.next_block(self.seconds))

    def step_back(self) -> None:
        """To the beginning of the block."""
        self.pause()
        self.go_to(self.simulation.block_before(self.seconds))

    def _tick(self) -> None:
        now = time.perf_counter()
        passed, self._last = now - self._last, now
        self.advance(passed * float(self.factor.currentText().rstrip("x")))

    def advance(self, seconds: float) -> None:
        """Go on by a time, no further than the next problem if the player stops at them."""
        to = min(self.seconds + seconds, self.simulation.duration)
        self.problem = self.simulation.problem_between(self.seconds, to) if self.stops.isChecked() else None
        self.go_to(to if self.problem is None else self.problem.time)
        if self.problem is not None or to >= self.simulation.duration:
            self.pause()

    def _ask(self) -> None:
        title = translate(_CONTEXT, "Folder for the pictures")
        folder = QtWidgets.QFileDialog.getExistingDirectory(self, title)
        if folder:
            self.write_pictures(Path(folder))

    def write_pictures(self, folder: Path, per_second: float = 30.0, width: int = 1280, height: int = 720) -> int:
        """Write the motion as PNG files at the speed that is chosen; how many there are.

        Args:
            folder: gets frame_00001.png and so on.
            per_second: pictures for each second of the film.
            width: of a picture, pixels.
            height: of a picture, pixels.
        """
        from pkm_post.freecad_app.progress import Progress, Stopped

        self.pause()
        view, before = FreeCADGui.getDocument(self._document).activeView(), self.seconds
        between = float(self.factor.currentText().rstrip("x")) / per_second
        count, written = int(self.simulation.duration / between) + 1, 0
        try:
            with Progress(translate(_CONTEXT, "Pictures"), count) as bar:
                for number in range(count):
                    self.go_to(number * between)
                    view.saveImage(str(folder / f"frame_{number + 1:05d}.png"), width, height, "Current")
                    written += 1
                    bar.step()
        except Stopped:
            FreeCAD.Console.PrintWarning(f"{written} of {count} pictures were written\n")
        self.go_to(before)
        return written

    def closeEvent(self, event: Any) -> None:
        """Give the view back."""
        self.pause()
        self._watch.end()
        self.stage.strike()
        super().closeEvent(event)
        self.deleteLater()


def _button(layout: Any, icon: str, tip: str, action: Any) -> QtWidgets.QToolButton:
    button = QtWidgets.QToolButton()
    button.setIcon(_icon(icon))
    button.setToolTip(tip)
    button.clicked.connect(lambda: action())
    layout.addWidget(button)
    return button


def _icon(name: str) -> Any:
    """An icon of Qt's own, so that the buttons look like those of other players here."""
    return QtWidgets.QApplication.style().standardIcon(getattr(QtWidgets.QStyle.StandardPixmap, name))


def play(job: Any, machine_object: Any = None) -> Player:
    """Plan the motion of a job and open the player; one that is open is closed.

    Raises:
        Refused: the job cannot be read or placed.
    """
    from pkm_post.freecad_app.simulation import simulate_job

    window = FreeCADGui.getMainWindow()
    for open_before in window.findChildren(QtWidgets.QDockWidget, _NAME):
        open_before.close()
    player = Player(simulate_job(job, machine_object), job.Document, machine_object)
    window.addDockWidget(QtCore.Qt.DockWidgetArea.BottomDockWidgetArea, player)
    return player
