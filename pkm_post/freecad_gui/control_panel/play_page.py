# SPDX-License-Identifier: LGPL-2.1-or-later
"""Play page: opens a trajectory and plays it while it is planned, with override, single block, block skip and retract.

Takes a file, reads it in the background, and passes the operator's orders to the play of the console. Hold, Resume and
Abort are on the stop bar. All labels keep their height, so that no button moves under the pointer.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.control.numerical_control import ControlState, Interlock, OperatorCommand, blocking_interlock
from pkm_post.control.player import Order, OrderKind, PlayOptions, WindowPlay, first_row, read_playable
from pkm_post.freecad_app.core_texts import fault_text
from pkm_post.freecad_gui.control_panel.buttons import (
    OrderButton,
    line_label,
    plain_button,
    refresh_all,
    set_usable,
    show_line,
    side_by_side,
)
from pkm_post.freecad_gui.control_panel.console import Console
from pkm_post.freecad_gui.control_panel.play_setup import NUMBER_WIDTH, BlockSkip, PlaySetup, Ready, trajectory_kinds
from pkm_post.freecad_gui.control_panel.texts import play_text, speeds_text, why_text
from pkm_post.freecad_gui.post_fields import narrow_box, quantity_field, show_quantity
from pkm_post.model import Diagnostics, Tolerances, Trajectory
from pkm_post.options import LONGEST_JOG

translate = FreeCAD.Qt.translate

_MOST_LINES = 100_000_000
_MOST_PERCENT, _STEP_PERCENT = 150, 5
_SHARES = 1000
"""Steps of the progress bar."""
_DRY_MM_S, _RETRACT_MM = 20.0, 10.0


class PlayPage(QtWidgets.QWidget):
    """The page.

    Attributes:
        name: of the opened file.
        open, play, go_on, end, retract: the buttons; ``retract_distance`` is for the last one.
        line, operation: the start.
        approach, repeat_codes, single_block, optional_stop, dry_run: the options; ``dry_feed`` is for the last one.
        skip: whether to skip ``/`` blocks, and the posting without them.
        setup: changes at the machine, and solids that the approach must not touch.
        override: the slider, per cent of the feed.
        place, speeds, bar: position, speed and completed share of the play.
    """

    def __init__(self, console: Console) -> None:
        super().__init__()
        self._console = console
        self._opened: tuple[Trajectory, Tolerances] | None = None
        self._file, self._way = Path(), 1.0
        self.name, self.place, self.speeds = (line_label() for _ in range(3))
        self.line, self.operation, self.bar = QtWidgets.QSpinBox(), narrow_box(), QtWidgets.QProgressBar()
        self.override, self._percent = QtWidgets.QSlider(QtCore.Qt.Orientation.Horizontal), QtWidgets.QLabel("100 %")
        self.dry_feed, self.retract_distance = quantity_field("mm/s"), quantity_field("mm")
        self.setup, self.skip = PlaySetup(), BlockSkip(console)
        self._make_choices()
        self._make_buttons()
        self._set_up()

    def _make_choices(self) -> None:
        self.approach, self.repeat_codes, self.single_block, self.optional_stop, self.dry_run = (
            QtWidgets.QCheckBox(text)
            for text in (
                translate("ControlPanel", "Approach first"),
                translate("ControlPanel", "Repeat M codes"),
                translate("ControlPanel", "Single block"),
                translate("ControlPanel", "Stop at M1"),
                translate("ControlPanel", "Dry run at"),
            )
        )
        self.approach.setToolTip(translate("ControlPanel", "Approach the start first; a start at a line always does"))
        self.repeat_codes.setToolTip(
            translate("ControlPanel", "Repeat the M codes of the machine before the line, each once, above it")
        )
        self.single_block.setToolTip(translate("ControlPanel", "Stop at the end of each line, until Continue"))
        self.dry_run.setToolTip(
            translate("ControlPanel", "Feed for all moves except rapids, without spindle, coolant and dwells")
        )
        self.single_block.toggled.connect(lambda on: self._order("single", float(on)))
        self.optional_stop.toggled.connect(lambda on: self._order("optional", float(on)))
        self.skip.box.toggled.connect(lambda on: self._order("skip", float(on)))

    def _make_buttons(self) -> None:
        self.open = plain_button(
            translate("ControlPanel", "Open"), translate("ControlPanel", "Open a posted trajectory"), self._ask
        )
        rows = (
            (translate("ControlPanel", "Play"), translate("ControlPanel", "Play it from the line onwards"),
             OperatorCommand.PLAY, self._play),
            (translate("ControlPanel", "Continue"),
             translate("ControlPanel", "Continue after a stop, a block, a tool or an override of 0"),
             OperatorCommand.PLAY_CONTINUE, lambda: self._order("start")),
            (translate("ControlPanel", "End"), translate("ControlPanel", "End it at the next stop on the path"),
             OperatorCommand.PLAY_END, lambda: self._order("end")),
            (translate("ControlPanel", "Retract by"),
             translate(
                 "ControlPanel", "Retract along the tool axis while it waits, as at feed 0; Continue returns first"),
             OperatorCommand.RETRACT, self._retract),
        )  # fmt: skip
        self.play, self.go_on, self.end, self.retract = (OrderButton(*row) for row in rows)

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
        self.dry_feed.setMinimumWidth(NUMBER_WIDTH)
        self.dry_feed.setProperty("minimum", 0.0)
        show_quantity(self.retract_distance, _RETRACT_MM, "mm")
        self.retract_distance.setProperty("minimum", 0.0)
        self.retract_distance.setProperty("maximum", float(LONGEST_JOG))
        self.bar.setRange(0, _SHARES)
        self.bar.setTextVisible(False)
        at_rest = (self.line, self.operation, self.approach, self.repeat_codes, self.dry_run, self.dry_feed)
        self._tips = {part: part.toolTip() for part in at_rest}
        above = (
            (self.open, self.name),
            (self.play, self.go_on, self.end),
            (QtWidgets.QLabel(translate("ControlPanel", "Feed")), self.override, self._percent),
        )
        below = (
            (self.retract, self.retract_distance),
            (QtWidgets.QLabel(translate("ControlPanel", "Begin at line")), self.line),
            (self.operation, self.approach),
            (self.repeat_codes, self.single_block),
            (self.optional_stop, self.dry_run, self.dry_feed),
        )
        layout = QtWidgets.QVBoxLayout(self)
        for row in above:
            layout.addLayout(side_by_side(*row))
        for part in (self.place, self.speeds, self.bar):  # visible in a low panel
            layout.addWidget(part)
        for row in below:
            layout.addLayout(side_by_side(*row))
        for part in (self.skip, self.setup):
            layout.addWidget(part)
        layout.addStretch(1)

    def refresh(self, _state: ControlState, found: frozenset[Interlock]) -> None:
        """Enable what is possible, and show the position of the play."""
        console = self._console
        if console.connection is None and self._opened is not None:
            self._forget()
        refresh_all((self.play, self.go_on, self.end, self.retract), found)
        rests = console.play is None
        self.open.setEnabled(rests and Interlock.NOT_CONNECTED not in found and not console.waits)
        for part, tip in self._tips.items():
            set_usable((part,), tip, "" if rests else why_text(Interlock.PLAYS))
        against = blocking_interlock(OperatorCommand.RETRACT, found)
        set_usable((self.retract_distance,), "", "" if against is None else why_text(against))
        self._refresh_setup(found)
        if self._opened is None:
            self.name.setText(translate("ControlPanel", "no trajectory was opened"))
        shown = None if console.play is None else console.play.state
        if shown is not None:
            show_line(self.place, play_text(shown))
            show_line(self.speeds, speeds_text(shown))
            self.bar.setValue(round(_SHARES * (1 - shown.to_go / self._way)))

    def _refresh_setup(self, found: frozenset[Interlock]) -> None:
        """Enable the fields of the set-up; during a play, only the block-skip switch."""
        plays = next((why_text(why) for why in (Interlock.PLAYS, Interlock.BUSY) if why in found), "")
        closed = why_text(Interlock.NO_TRAJECTORY) if self._opened is None else ""
        self.setup.refresh(plays, closed)
        self.skip.refresh(plays, closed)

    def _forget(self) -> None:
        """Close the trajectory: it is for the machine of the ended connection."""
        self._opened = None
        self.skip.file.take(())
        self.setup.take(None)
        self.operation.clear()
        self.place.clear()
        self.speeds.clear()
        self.bar.setValue(0)

    def _ask(self) -> None:
        name = QtWidgets.QFileDialog.getOpenFileName(
            self, translate("ControlPanel", "Open a trajectory"), "", trajectory_kinds()
        )[0]
        if name:
            self.read(Path(name))

    def read(self, file: Path) -> None:
        """Read a trajectory file in the background."""
        connection = self._console.connection
        assert connection is not None
        machine = connection.target.machine
        self._console.calls.do(lambda: read_playable(file, machine), lambda read: self._take(file, *read))

    def _take(
        self, file: Path, trajectory: Trajectory | None, tolerances: Tolerances | None, diagnostics: Diagnostics
    ) -> None:
        for each in diagnostics:
            self._console.message.emit(fault_text(each), trajectory is None)
        if trajectory is None or tolerances is None or self._console.connection is None:
            return
        self._opened, self._file = (trajectory, tolerances), file
        self._way = max(float(trajectory.length.sum()), math.ulp(1.0))
        self._console.has_trajectory = True
        self.skip.file.take(())
        self.setup.take(trajectory)
        show_line(self.name, file.name, str(file))
        self.operation.clear()
        self.operation.addItem(translate("ControlPanel", "of any operation"), "")
        for name in filter(None, dict.fromkeys(trajectory.operations)):
            self.operation.addItem(name, name)
        self._console.refreshed.emit()

    def _first_row(self, trajectory: Trajectory) -> int | None:
        """The first row to play; None if there is no such line."""
        line, operation = self.line.value(), str(self.operation.currentData() or "")
        if line == 0 and not operation:
            return 0
        row, diagnostics = first_row(trajectory, line, operation, self._file, self.repeat_codes.isChecked())
        for each in diagnostics:
            self._console.message.emit(fault_text(each), row is None)
        return row

    def _play(self) -> None:
        connection, opened = self._console.connection, self._opened
        assert connection is not None and opened is not None
        if self.dry_run.isChecked() and self.dry_feed.property("rawValue") <= 0.0:
            self._console.message.emit(translate("ControlPanel", "Not sent: the speed must be above zero"), True)
            return
        row = self._first_row(opened[0])
        if row is None:
            return
        stops = self._console.stop_count
        ready = self.setup.preparation(opened[0], self.skip.without, connection.target.machine)
        self._console.calls.do(ready, lambda made: self._begin(stops, row, made))

    def _choices(self, row: int) -> PlayOptions:
        """The options, without those read from files."""
        dry = float(self.dry_feed.property("rawValue")) if self.dry_run.isChecked() else None
        return PlayOptions(
            override=self.override.value() / 100,
            single_block=self.single_block.isChecked(),
            optional_stop=self.optional_stop.isChecked(),
            block_skip=self.skip.box.isChecked(),
            dry_feed=dry,
            first_row=row,
            approach=self.approach.isChecked(),
            repeat_codes=self.repeat_codes.isChecked(),
        )

    def _begin(self, stops: int, row: int, ready: Ready) -> None:
        """Start the prepared play, unless a stop came first."""
        for each in ready.diagnostics:
            self._console.message.emit(fault_text(each), False)
        connection, opened = self._console.connection, self._opened
        if connection is None or opened is None or stops != self._console.stop_count:
            self._console.message.emit(translate("ControlPanel", "Not executed: a stop came first"), False)
            return
        choices = replace(self._choices(row), skipped=ready.skipped, setup=ready.setup)
        self._console.begin_play(WindowPlay(connection, ready.trajectory, opened[1], choices))

    def _retract(self) -> None:
        retract_distance = float(self.retract_distance.property("rawValue"))
        if retract_distance <= 0.0:
            self._console.message.emit(translate("ControlPanel", "Not sent: the distance must be above zero"), True)
            return
        self._order("retract", retract_distance)

    def _override_changed(self, percent: int) -> None:
        self._percent.setText(f"{percent} %")
        self._order("override", percent / 100)

    def _order(self, kind: OrderKind, value: float = 0.0) -> None:
        if self._console.play is not None:
            self._console.play.order(Order(kind, value))
