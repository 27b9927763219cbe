# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program page: opens, loads and starts a motion program, or runs it line by line of its source.

Takes a file, reads it in the background, and sends it to the controller on request.
"""

from __future__ import annotations

from pathlib import Path

import FreeCAD
from PySide import QtWidgets

from pkm_post.control.link import PmacJob
from pkm_post.control.loading import job_to_load
from pkm_post.control.numerical_control import (
    ControlState,
    Interlock,
    MovePlan,
    OperatorCommand,
    ProgramBlocks,
    read_blocks,
)
from pkm_post.freecad_app.core_texts import fault_text
from pkm_post.freecad_gui.control_panel.buttons import OrderButton, plain_button, refresh_all, side_by_side
from pkm_post.freecad_gui.control_panel.console import Console
from pkm_post.freecad_gui.quantities import seconds_text
from pkm_post.model import Diagnostics

translate = FreeCAD.Qt.translate

_MOST_BLOCKS = 1_000_000


class ProgramPage(QtWidgets.QWidget):
    """The page.

    Attributes:
        name: of the opened file.
        open, load, cancel, approach, start, begin_at, step, go_on: the buttons.
        block, stop: numbers of the start block, and of the stop to continue from.
        bar: loaded share.
    """

    def __init__(self, console: Console) -> None:
        super().__init__()
        self._console, self._file = console, Path()
        self.name, self.block, self.bar = QtWidgets.QLabel(), QtWidgets.QSpinBox(), QtWidgets.QProgressBar()
        self.stop = QtWidgets.QSpinBox()
        self.block.setRange(1, _MOST_BLOCKS)
        self.stop.setMinimum(1)
        self.open = plain_button(
            translate("ControlPanel", "Open"), translate("ControlPanel", "Open a motion program"), self._ask
        )
        self.cancel = plain_button(
            translate("ControlPanel", "Cancel"), translate("ControlPanel", "Stop loading"), console.cancel_load
        )
        rows = (
            (translate("ControlPanel", "Load"), translate("ControlPanel", "Load it, list it back and compare"),
             OperatorCommand.LOAD, console.load),
            (translate("ControlPanel", "Approach"),
             translate("ControlPanel", "Bring the tool to the start of the program, planned and checked"),
             OperatorCommand.APPROACH, self._approach),
            (translate("ControlPanel", "Start"), translate("ControlPanel", "Start it from its beginning"),
             OperatorCommand.START, self._start),
            (translate("ControlPanel", "Begin at block"), translate("ControlPanel", "Use it for single block"),
             OperatorCommand.BLOCKS, self._begin_at),
            (translate("ControlPanel", "Next block"),
             translate("ControlPanel", "Run the next line of its source, to rest"), OperatorCommand.STEP, self._step),
            (translate("ControlPanel", "Continue after stop"),
             translate("ControlPanel", "Continue after the stop (M0, M1) at which the machine waits"),
             OperatorCommand.CONTINUE, self._go_on),
        )  # fmt: skip
        self.load, self.approach, self.start, self.begin_at, self.step, self.go_on = (OrderButton(*row) for row in rows)
        layout = QtWidgets.QVBoxLayout(self)
        self.bar.setTextVisible(False)
        rows_below = (
            (self.open, self.name),
            (self.load, self.cancel, self.bar),
            (self.approach, self.start),
            (self.begin_at, self.block),
            (self.step, self.go_on, self.stop),
        )
        for row in rows_below:
            layout.addLayout(side_by_side(*row))
        layout.addStretch(1)

    def refresh(self, _state: ControlState, found: frozenset[Interlock]) -> None:
        """Enable what is possible, and show the progress of loading."""
        console, (done, lines) = self._console, self._console.progress
        refresh_all((self.load, self.approach, self.start, self.begin_at, self.step, self.go_on), found)
        self.open.setEnabled(Interlock.NOT_CONNECTED not in found and not console.waits)
        self.cancel.setEnabled(console.has_orders and not console.loaded and lines > 0)
        self.bar.setRange(0, max(lines, 1))
        self.bar.setValue(done)
        if console.job is None:
            self.name.setText(translate("ControlPanel", "no program was opened"))

    def _ask(self) -> None:
        title, kinds = translate("ControlPanel", "Open a motion program"), translate("ControlPanel", "Motion programs")
        name = QtWidgets.QFileDialog.getOpenFileName(self, title, "", f"{kinds} (*.pmc)")[0]
        if name:
            self.read(Path(name))

    def read(self, file: Path, uncertified: bool = False) -> None:
        """Read a program file in the background, certified or, on request of a macro, ``uncertified``."""
        connection = self._console.connection
        assert connection is not None
        target = connection.target

        def reading() -> tuple[PmacJob | None, Diagnostics]:
            return job_to_load(file, target.machine, target.settings, uncertified)

        self._console.calls.do(reading, lambda read: self._take(file, *read))

    def _take(self, file: Path, job: PmacJob | None, diagnostics: Diagnostics) -> None:
        for each in diagnostics:
            self._console.message.emit(fault_text(each), job is None)
        if job is not None and self._console.connection is not None:
            self._console.take_job(job)
            self._file = file
            self.stop.setMaximum(max(1, self._console.stops))
            self.name.setText(f"{file.name}, {seconds_text(job.motion.time_ms[-1] / 1000)}")
            self.name.setToolTip(str(file))

    def _approach(self) -> None:
        job = self._console.job
        self._console.move(lambda control: control.plan_approach(job), self._planned)

    def _planned(self, plan: MovePlan | None) -> None:
        if plan is None:
            self._console.message.emit(translate("ControlPanel", "Not sent: no approach to the start was found"), True)

    def _start(self) -> None:
        job = self._console.job
        self._console.order(lambda control: control.start(job))

    def _go_on(self) -> None:
        job, stop = self._console.job, self.stop.value()
        self._console.loaded = False  # its remainder replaces it in the controller
        self._console.order(lambda control: control.continue_after_stop(job, stop))

    def _begin_at(self) -> None:
        file, connection, at = self._file, self._console.connection, self.block.value()
        assert connection is not None
        machine = connection.target.machine
        self._console.calls.do(lambda: read_blocks(file, machine), lambda found: self._take_blocks(*found, at))

    def _take_blocks(self, blocks: ProgramBlocks | None, diagnostics: Diagnostics, at: int) -> None:
        for each in diagnostics:
            self._console.message.emit(fault_text(each), blocks is None)
        if blocks is not None and self._console.connection is not None:
            first = min(at, len(blocks))
            begun, found = blocks.begun_at(first, self._console.connection.target.machine)
            for each in found:
                self._console.message.emit(fault_text(each), False)
            opened = lambda count: self._opened(count, first)  # noqa: E731
            self._console.order(lambda control: control.open_blocks(begun, first), opened)

    def _opened(self, count: int, first: int) -> None:
        self._console.stepping = True
        text = translate("ControlPanel", "The program has {} blocks; block {} comes next")
        self._console.message.emit(text.format(count, first), False)

    def _step(self) -> None:
        self._console.move(lambda control: control.plan_step(), self._stepped)

    def _stepped(self, plan: MovePlan | None) -> None:
        if plan is None:
            self._console.message.emit(translate("ControlPanel", "Not sent: the block is refused"), True)
