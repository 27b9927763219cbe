# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panel: the content of the numerical control dock, from top to bottom, refreshed as one."""

from __future__ import annotations

from collections.abc import Callable

import FreeCAD
import numpy as np
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.control.numerical_control import Connection, ControlState
from pkm_post.freecad_app.core_texts import fault_text, stored_fault
from pkm_post.freecad_gui.control_panel.buttons import line_label, show_line
from pkm_post.freecad_gui.control_panel.connect_page import ConnectPage
from pkm_post.freecad_gui.control_panel.console import Console
from pkm_post.freecad_gui.control_panel.dro import PositionDisplay, StrutTable
from pkm_post.freecad_gui.control_panel.machine_follower import Follower
from pkm_post.freecad_gui.control_panel.mdi_page import MdiPage
from pkm_post.freecad_gui.control_panel.motion_pages import HomingPage, JogPage
from pkm_post.freecad_gui.control_panel.play_page import PlayPage
from pkm_post.freecad_gui.control_panel.program_page import ProgramPage
from pkm_post.freecad_gui.control_panel.stop_bar import StopBar
from pkm_post.freecad_gui.control_panel.texts import activity_text, emergency_text, progress_text
from pkm_post.freecad_gui.fault_links import link_codes
from pkm_post.freecad_gui.theme import theme
from pkm_post.geometry import Array

translate = FreeCAD.Qt.translate

_MOST_TOLD, _LINES_TOLD = 200, 3
_ACTIVITY_LINES = 2
_BESIDE_BAR = 6
"""px between the digits and the scroll bar."""
_MARGIN = 4
"""px around the parts, and between them."""
_RED = "background-color: #cc0000; color: white; font-weight: bold; padding: 4px;"
_YELLOW = "background-color: #edd400; color: black; font-weight: bold; padding: 4px;"


class PanelContent(QtWidgets.QWidget):
    """The parts.

    Attributes:
        training: label of a simulated machine.
        banner: fault of the link, and the action required.
        progress: line, feed, time left and operation of the play, always visible.
        dro, struts, stops: digital readout of the pose, struts, and the stop bar.
        connecting, homing, jog, mdi, program, play: the pages.
        follows: whether the machine object of the document follows the machine.
        messages: all messages, the newest last.
    """

    def __init__(self, console: Console, leave: Callable[[], None]) -> None:
        super().__init__()
        self._console, self._follower = console, Follower()
        self._connection: Connection | None = None
        self.training = QtWidgets.QLabel(
            translate("ControlPanel", "SIMULATED MACHINE: for training. Nothing real moves.")
        )
        self.banner, self.activity, self.messages = QtWidgets.QLabel(), QtWidgets.QLabel(), QtWidgets.QListWidget()
        self.progress = line_label()
        self.dro, self.struts, self.stops = PositionDisplay(), StrutTable(), StopBar(console)
        self.follows = QtWidgets.QCheckBox(translate("ControlPanel", "The machine of the document follows"))
        self.follows.toggled.connect(self._follow)
        self.connecting, self.homing, self.jog = ConnectPage(console, leave), HomingPage(console), JogPage(console)
        self.mdi, self.program = MdiPage(console, self.dro.work_offset), ProgramPage(console)
        self.play = PlayPage(console)
        self.pages = self._pages()
        self._set_up()
        console.message.connect(self.show_message)
        console.refreshed.connect(self.refresh)

    def _pages(self) -> QtWidgets.QTabWidget:
        pages = QtWidgets.QTabWidget()
        pages.addTab(self.connecting, translate("ControlPanel", "Connection"))
        pages.addTab(self.homing, translate("ControlPanel", "Homing"))
        pages.addTab(self.jog, translate("ControlPanel", "Jog"))
        pages.addTab(self.mdi, translate("ControlPanel", "MDI"))
        pages.addTab(self.program, translate("ControlPanel", "Program"))
        pages.addTab(self.play, translate("ControlPanel", "Play"))
        state = QtWidgets.QWidget()
        inside = QtWidgets.QVBoxLayout(state)
        inside.addWidget(self.struts)
        inside.addWidget(self.follows)
        inside.addStretch(1)
        pages.addTab(state, translate("ControlPanel", "Struts"))
        pages.tabBar().setUsesScrollButtons(True)
        return pages

    def _set_up(self) -> None:
        for label in (self.training, self.banner, self.activity):
            label.setWordWrap(True)
        self.activity.setFixedHeight(_ACTIVITY_LINES * self.fontMetrics().lineSpacing())  # parts below stay in place
        self.activity.setAlignment(QtCore.Qt.AlignmentFlag.AlignTop)
        self.training.setStyleSheet(_YELLOW)
        self.messages.setWordWrap(True)
        link_codes(self.messages)
        self.messages.setFixedHeight(_LINES_TOLD * self.fontMetrics().height())
        self.messages.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        seen, above = QtWidgets.QWidget(), QtWidgets.QScrollArea()
        inside = QtWidgets.QVBoxLayout(seen)
        inside.setContentsMargins(0, 0, _BESIDE_BAR, 0)
        for part in (self.activity, self.dro, self.pages):
            inside.addWidget(part)
        above.setWidget(seen)
        above.setWidgetResizable(True)
        above.setFrameShape(QtWidgets.QFrame.Shape.NoFrame)
        above.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        above.setMinimumWidth(seen.minimumSizeHint().width() + above.verticalScrollBar().sizeHint().width())
        above.setMinimumHeight(1)  # on a low screen the banner needs all the room
        layout = QtWidgets.QVBoxLayout(self)
        layout.setContentsMargins(_MARGIN, _MARGIN, _MARGIN, _MARGIN)
        layout.setSpacing(_MARGIN)
        layout.addWidget(self.training)
        layout.addWidget(above, 1)
        layout.addWidget(self.banner)  # only the scroll area shrinks when it appears
        layout.addWidget(self.progress)
        layout.addWidget(self.stops)
        layout.addWidget(self.messages)

    def show_message(self, text: str, is_bad: bool) -> None:
        """Add a message."""
        item = QtWidgets.QListWidgetItem(text)
        if is_bad:
            item.setForeground(QtGui.QBrush(QtGui.QColor(theme().bad)))
        self.messages.addItem(item)
        while self.messages.count() > _MOST_TOLD:
            self.messages.takeItem(0)
        self.messages.scrollToBottom()

    def refresh(self) -> None:
        """Show the latest state."""
        console = self._console
        state, found, connection = console.state, console.found(), console.connection
        if connection is not self._connection:
            self._take(connection)
        self._show_link(state)
        activity = activity_text(state) if connection else translate("ControlPanel", "Not connected")
        self.activity.setText(activity)
        self.activity.setToolTip(activity)
        shown = None if console.play is None else console.play.state
        show_line(self.progress, "" if shown is None else progress_text(shown))
        self.dro.refresh(state.pose, self._machine_from_work())
        self.struts.refresh(state.status)
        for part in (self.connecting, self.homing, self.jog, self.mdi, self.program, self.play, self.stops):
            part.refresh(state, found)
        self._follower.show(state.pose, self.connecting.taken_length)

    def _take(self, connection: Connection | None) -> None:
        """Switch to another machine, or to none."""
        self._connection = connection
        self.dro.work_offset.clear()
        if connection is not None:
            self.dro.work_offset.addItems(sorted(connection.target.machine.work_offsets))
            self.pages.setCurrentWidget(self.homing)
        self._follow(self.follows.isChecked())

    def _machine_from_work(self) -> Array:
        """The (4, 4) pose of the selected work frame."""
        if self._connection is None:
            return np.eye(4)
        return self._connection.target.machine.work_offsets.get(self.dro.work_offset.currentText(), np.eye(4))

    def _show_link(self, state: ControlState) -> None:
        lines = []
        if state.emergency:
            lines.append(emergency_text(state.emergency))
        if state.lost:
            fault = stored_fault(state.lost)
            lost = state.lost if fault is None else fault_text(fault)
            lines.append(translate("ControlPanel", "No link: {}").format(lost))
        if self._console.waits:
            lines.append(translate("ControlPanel", "Please wait: connecting, disconnecting or reading"))
        style = _RED if state.lost or state.emergency else _YELLOW
        if self.banner.styleSheet() != style:
            self.banner.setStyleSheet(style)
        self.banner.setText("\n".join(lines))
        self.banner.setVisible(bool(lines))
        self.training.setVisible(self._connection is not None and self._connection.simulated)

    def _follow(self, wished: bool) -> None:
        if not wished or self._connection is None:
            self._follower.end()
        elif not self._follower.begin(FreeCAD.ActiveDocument, self._connection.target.machine):
            text = translate("ControlPanel", "The active document has no machine object of this machine that is free")
            self.show_message(text, False)
            self.follows.setChecked(False)
