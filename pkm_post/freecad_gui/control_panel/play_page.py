# SPDX-License-Identifier: LGPL-2.1-or-later
"""Play page: opens a trajectory and plays it while it is planned, with override, single block, and where it is.

Takes a file, reads it beside the window, and gives the orders of the operator to the play of the console. Hold, Resume
and Abort are those of the stop bar. All labels keep their height, so that nothing moves under the hand.
"""

from __future__ import annotations

import math
from pathlib import Path

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.control.numerical_control import ControlState, Interlock, OperatorCommand
from pkm_post.control.player import Order, OrderKind, PlayOptions, WindowPlay, first_row, read_playable
from pkm_post.freecad_gui.control_panel.buttons import OrderButton, plain_button, refresh_all, side_by_side
from pkm_post.freecad_gui.control_panel.console import Console
from pkm_post.freecad_gui.control_panel.play_texts import placed_text, speeds_text
from pkm_post.freecad_gui.post_fields import quantity_field, show_quantity
from pkm_post.model import Diagnostic, Tolerances, Trajectory

translate = FreeCAD.Qt.translate

_MOST_LINES = 100_000_000
_MOST_PERCENT, _STEP_PERCENT = 150, 5
_SHARES = 1000
"""Steps of the progress bar."""
_DRY_MM_S = 20.0


class PlayPage(QtWidgets.QWidget):
    """The page.

    Attributes:
        name: of the opened file.
        open, play, go_on, end: the buttons.
        line, operation: where to begin.
        approach, single_block, optional_stop, dry_run: the choices; ``dry_feed`` belongs to the last one.
        override: the slider, per cent of the feed.
        place, speeds, bar: where the play is, how fast it is, and the share of its way.
    """

    def __init__(self, console: Console) -> None:
        super().__init__()
        self._console = console
        self._opened: tuple[Trajectory, Tolerances] | None = None
        self._file, self._way = Path(), 1.0
        self.name, self.place, self.speeds = (_line() for _ in range(3))
        self.line, self.operation, self.bar = QtWidgets.QSpinBox(), QtWidgets.QComboBox(), QtWidgets.QProgressBar()
        self.override, self._percent = QtWidgets.QSlider(QtCore.Qt.Orientation.Horizontal), QtWidgets.QLabel("100 %")
        self.dry_feed = quantity_field("mm/s")
        self._make_choices()
        self._make_buttons()
        self._set_up()

    def _make_choices(self) -> None:
        self.approach, self.single_block, self.optional_stop, self.dry_run = (
            QtWidgets.QCheckBox(text)
            for text in (
                translate("ControlPanel", "Approach first"),
                translate("ControlPanel", "Single block"),
                translate("ControlPanel", "Stop at M1"),
                translate("ControlPanel", "Dry run at"),
            )
        )
        self.approach.setToolTip(translate("ControlPanel", "Bring the tool to the beginning; to a line always"))
        self.single_block.setToolTip(translate("ControlPanel", "Rest at the end of each line, until Go on"))
        self.dry_run.setToolTip(
            translate("ControlPanel", "This feed for all moves but rapid ones, without spindle, coolant and dwells")
        )
        self.single_block.toggled.connect(lambda on: self._order("single", float(on)))

    def _make_buttons(self) -> None:
        self.open = plain_button(
            translate("ControlPanel", "Open"), translate("ControlPanel", "Open a trajectory that was posted"), self._ask
        )
        rows = (
            (translate("ControlPanel", "Play"), translate("ControlPanel", "Play it from the line on"),
             OperatorCommand.PLAY, self._play),
            (translate("ControlPanel", "Go on"),
             translate("ControlPanel", "Go on after a stop, a block, a tool or an override of 0"),
             OperatorCommand.PLAY_ON, lambda: self._order("start")),
            (translate("ControlPanel", "End"), translate("ControlPanel", "End it at the next stop on the path"),
             OperatorCommand.PLAY_END, lambda: self._order("end")),
        )  # fmt: skip
        self.play, self.go_on, self.end = (OrderButton(*row) for row in rows)

    def _set_up(self) -> None:
        self.line.setRange(0, _MOST_LINES)
        self.line.setSpecialValueText(translate("ControlPanel", "the beginning"))
        self.override.setRange(0, _MOST_PERCENT)
        self.override.setSingleStep(_STEP_PERCENT)
        self.override.setValue(100)
        self.override.setToolTip(
            translate("ControlPanel", "Feed along the path; rapid moves are not faster than at 100 %")
        )
        self.override.valueChanged.connect(self._override_changed)
        self._percent.setMinimumWidth(self._percent.fontMetrics().horizontalAdvance("150 %"))
        show_quantity(self.dry_feed, _DRY_MM_S, "mm/s")
        self.bar.setRange(0, _SHARES)
        self.bar.setTextVisible(False)
        rows = (
            (self.open, self.name),
            (QtWidgets.QLabel(translate("ControlPanel", "Begin at line")), self.line, self.operation),
            (self.approach, self.single_block, self.optional_stop),
            (self.dry_run, self.dry_feed),
            (self.play, self.go_on, self.end),
            (QtWidgets.QLabel(translate("ControlPanel", "Feed")), self.override, self._percent),
        )
        layout = QtWidgets.QVBoxLayout(self)
        for row in rows:
            layout.addLayout(side_by_side(*row))
        for part in (self.place, self.speeds, self.bar):
            layout.addWidget(part)
        layout.addStretch(1)

    def refresh(self, _state: ControlState, found: frozenset[Interlock]) -> None:
        """Enable what is possible, and show where the play is."""
        console = self._console
        if console.connection is None and self._opened is not None:
            self._forget()
        refresh_all((self.play, self.go_on, self.end), found)
        rests = console.play is None
        self.open.setEnabled(
            rests and not {Interlock.NOT_CONNECTED, Interlock.WATCH_ONLY} & found and not console.waits
        )
        for part in (self.line, self.operation, self.approach, self.optional_stop, self.dry_run, self.dry_feed):
            part.setEnabled(rests)
        if self._opened is None:
            self.name.setText(translate("ControlPanel", "no trajectory was opened"))
        shown = None if console.play is None else console.play.state
        if shown is not None:
            _show(self.place, placed_text(shown))
            _show(self.speeds, speeds_text(shown))
            self.bar.setValue(round(_SHARES * (1 - shown.to_go / self._way)))

    def _forget(self) -> None:
        """The connection has ended, and what was opened belongs to its machine."""
        self._opened = None
        self.operation.clear()
        self.place.clear()
        self.speeds.clear()
        self.bar.setValue(0)

    def _ask(self) -> None:
        title, kinds = translate("ControlPanel", "Open a trajectory"), translate("ControlPanel", "Trajectories")
        name = QtWidgets.QFileDialog.getOpenFileName(self, title, "", f"{kinds} (*.pkmt)")[0]
        if name:
            self.read(Path(name))

    def read(self, file: Path) -> None:
        """Read a trajectory file beside the window."""
        connection = self._console.connection
        assert connection is not None
        machine = connection.target.machine
        self._console.calls.do(lambda: read_playable(file, machine), lambda read: self._take(file, *read))

    def _take(
        self,
        file: Path,
        trajectory: Trajectory | None,
        tolerances: Tolerances | None,
        diagnostics: tuple[Diagnostic, ...],
    ) -> None:
        for each in diagnostics:
            self._console.message.emit(str(each), trajectory is None)
        if trajectory is None or tolerances is None or self._console.connection is None:
            return
        self._opened, self._file = (trajectory, tolerances), file
        self._way = max(float(trajectory.length.sum()), math.ulp(1.0))
        self._console.has_trajectory = True
        _show(self.name, file.name, str(file))
        self.operation.clear()
        self.operation.addItem(translate("ControlPanel", "of any operation"), "")
        for name in filter(None, dict.fromkeys(trajectory.operations)):
            self.operation.addItem(name, name)
        self._console.refreshed.emit()

    def _first_row(self, trajectory: Trajectory) -> int | None:
        """The row to begin with; None if there is no such line."""
        line, operation = self.line.value(), str(self.operation.currentData() or "")
        if line == 0 and not operation:
            return 0
        row, diagnostics = first_row(trajectory, line, operation, self._file)
        for each in diagnostics:
            self._console.message.emit(str(each), row is None)
        return row

    def _play(self) -> None:
        connection, opened = self._console.connection, self._opened
        assert connection is not None and opened is not None
        row = self._first_row(opened[0])
        if row is None:
            return
        dry = float(self.dry_feed.property("rawValue")) if self.dry_run.isChecked() else None
        choices = PlayOptions(
            override=self.override.value() / 100,
            single_block=self.single_block.isChecked(),
            optional_stop=self.optional_stop.isChecked(),
            dry_feed=dry,
            first_row=row,
            approach=self.approach.isChecked(),
        )
        self._console.begin_play(WindowPlay(connection, *opened, choices))

    def _override_changed(self, percent: int) -> None:
        self._percent.setText(f"{percent} %")
        self._order("override", percent / 100)

    def _order(self, kind: OrderKind, value: float = 0.0) -> None:
        """Give an order, if something is played."""
        if self._console.play is not None:
            self._console.play.order(Order(kind, value))


def _line() -> QtWidgets.QLabel:
    """A label of one line that takes the width there is."""
    label = QtWidgets.QLabel()
    label.setSizePolicy(QtWidgets.QSizePolicy.Policy.Ignored, QtWidgets.QSizePolicy.Policy.Fixed)
    label.setMinimumHeight(label.fontMetrics().height())
    return label


def _show(label: QtWidgets.QLabel, text: str, tip: str = "") -> None:
    """Show a text, shortened to the width; the tip has all of it."""
    mode = QtCore.Qt.TextElideMode.ElideRight
    label.setText(label.fontMetrics().elidedText(text, mode, max(label.width(), 1)))
    label.setToolTip(tip or text)
