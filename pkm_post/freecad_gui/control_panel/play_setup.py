# SPDX-License-Identifier: LGPL-2.1-or-later
"""Play set-up: block skip, changes since posting, and the solids that the approach to a line must not touch.

Takes an opened trajectory; gives the offsets and the set-up of its play, in mm, as ``pkm-post play`` takes them from
``--shift``, ``--tool-length``, ``--part``, ``--stock`` and ``--fixture``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import FreeCAD
from PySide import QtWidgets

from pkm_post.control.player import collisions_at_offsets, read_playable
from pkm_post.freecad_app.core_texts import fault_text
from pkm_post.freecad_gui.control_panel.buttons import FilesField, set_usable, side_by_side
from pkm_post.freecad_gui.control_panel.console import Console
from pkm_post.freecad_gui.gauge_table import LengthField
from pkm_post.freecad_gui.post_fields import quantity_field, show_quantity
from pkm_post.model import Diagnostics, Machine, Refused, Setup, Tolerances, Trajectory, errors
from pkm_post.options import FARTHEST_OFFSET, LONGEST_TOOL, MeshFiles, Options
from pkm_post.posting import effective_setup
from pkm_post.toolpath import MachineOffsets, with_machine_offsets

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_SOLIDS = {
    "part": (QT_TRANSLATE_NOOP("ControlPanel", "Part"), QT_TRANSLATE_NOOP("ControlPanel", "The finished part")),
    "stock": (
        QT_TRANSLATE_NOOP("ControlPanel", "Stock"),
        QT_TRANSLATE_NOOP("ControlPanel", "The stock before the first operation"),
    ),
    "fixtures": (
        QT_TRANSLATE_NOOP("ControlPanel", "Fixtures"),
        QT_TRANSLATE_NOOP("ControlPanel", "Clamps and vices, one or several files"),
    ),
}
"""Label and tooltip of each solid."""
NUMBER_WIDTH = 80
"""Minimum, px: FreeCAD's own hints have room for many more digits."""


@dataclass(frozen=True)
class Ready:
    """The inputs of a play.

    Attributes:
        trajectory: with the offsets applied.
        skipped: the same program without its ``/`` blocks; None if there is none.
        setup: the known solids.
        diagnostics: warnings.
    """

    trajectory: Trajectory
    skipped: Trajectory | None
    setup: Setup
    diagnostics: Diagnostics


class BlockSkip(QtWidgets.QWidget):
    """The switch, and the posting without the skipped blocks.

    Attributes:
        file: file of the posting.
        without: the posting; None if there is none.
    """

    def __init__(self, console: Console) -> None:
        super().__init__()
        self._console, self.without = console, None
        self.box = QtWidgets.QCheckBox(translate("ControlPanel", "Skip /"))
        self.file = FilesField(
            translate("ControlPanel", "The posting with the blocks after / skipped"), trajectory_kinds()
        )
        self.file.changed.connect(self._read)
        layout = QtWidgets.QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.box)
        layout.addWidget(self.file, 1)

    def refresh(self, why: str, closed: str) -> None:
        """Enable what is possible; empty reasons enable the choice of another file."""
        tip = translate("ControlPanel", "The same program posted with --block-delete")
        self.file.refresh(tip, why or closed)
        without = translate("ControlPanel", "no posting with the blocks after / skipped was opened")
        tip = translate("ControlPanel", "Skip the next blocks after /")
        set_usable((self.box,), tip, "" if self.without is not None else closed or without)

    def _read(self) -> None:
        self.without, connection, files = None, self._console.connection, self.file.files
        if connection is None or not files:
            return
        file, machine = Path(files[0]), connection.target.machine
        self._console.calls.do(lambda: read_playable(file, machine), lambda read: self._take(files, *read))

    def _take(
        self,
        files: tuple[str, ...],
        trajectory: Trajectory | None,
        _tolerances: Tolerances | None,
        diagnostics: Diagnostics,
    ) -> None:
        for each in diagnostics:
            self._console.message.emit(fault_text(each), trajectory is None)
        if files != self.file.files:
            return  # another file was chosen meanwhile
        if trajectory is None:
            self.file.take(())
        self.without = trajectory
        self._console.refreshed.emit()


class PlaySetup(QtWidgets.QGroupBox):
    """The fields, below those of the play.

    Attributes:
        shift: fields of the shift of the work offset in {M}, by axis.
        tool, length: a tool of the trajectory, and its present gauge length.
        solids: fields of the files, by name.
    """

    def __init__(self) -> None:
        super().__init__(translate("ControlPanel", "At the machine"))
        self._lengths: dict[int, float] = {}
        self._posted: dict[int, float] = {}
        self.shift = {name: quantity_field("mm") for name in "XYZ"}
        self.tool, self.length = QtWidgets.QComboBox(), LengthField(0.0)
        solids = translate("ControlPanel", "Solids")
        self.solids = {
            name: FilesField(
                translate("ControlPanel", label), f"{solids} (*.stl *.step *.stp)", many=name == "fixtures"
            )
            for name, (label, _) in _SOLIDS.items()
        }
        for field in self.shift.values():
            field.setProperty("minimum", -float(FARTHEST_OFFSET))
            field.setProperty("maximum", float(FARTHEST_OFFSET))
        for field in (*self.shift.values(), self.length):
            field.setMinimumWidth(NUMBER_WIDTH)
        self.tool.currentIndexChanged.connect(lambda _row: self._show_length())
        self.length.editingFinished.connect(self._take_length)
        self._lay_out()

    def _lay_out(self) -> None:
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(
            QtWidgets.QLabel(translate("ControlPanel", "Shift of the work offset since the posting: X, Y, Z"))
        )
        layout.addLayout(side_by_side(*self.shift.values()))
        layout.addLayout(
            side_by_side(QtWidgets.QLabel(translate("ControlPanel", "Tool length")), self.tool, self.length)
        )
        text = translate("ControlPanel", "Check the approach against")
        layout.addWidget(QtWidgets.QLabel(text))
        grid = QtWidgets.QGridLayout()
        for row, (name, (label, _)) in enumerate(_SOLIDS.items()):
            grid.addWidget(QtWidgets.QLabel(translate("ControlPanel", label)), row, 0)
            grid.addWidget(self.solids[name], row, 1)
        grid.setColumnStretch(1, 1)
        grid.setVerticalSpacing(2)
        layout.addLayout(grid)

    def refresh(self, why: str, why_no_tools: str) -> None:
        """Enable what is possible; the reasons, against all and against tool lengths, are empty for none."""
        tip = translate("ControlPanel", "Displacement of the work offset in the machine frame, as printed by measure")
        set_usable(self.shift.values(), tip, why)
        tip = translate("ControlPanel", "Current gauge length of the tool, if changed since the posting")
        set_usable((self.tool, self.length), tip, why or why_no_tools)
        ours = translate("ControlPanel", "STL or STEP file, mm in the work frame")
        for name, field in self.solids.items():
            field.refresh(f"{translate('ControlPanel', _SOLIDS[name][1])}\n{ours}", why)

    def take(self, trajectory: Trajectory | None) -> None:
        """Show the tools of a trajectory with their posted lengths, and reset all offsets."""
        tools = () if trajectory is None else sorted(trajectory.tools.values(), key=lambda tool: tool.number)
        self._posted, self._lengths = {tool.number: tool.length for tool in tools}, {}
        for field in self.shift.values():
            show_quantity(field, 0.0, "mm")
        self.tool.clear()
        for number in self._posted:
            self.tool.addItem(f"T{number}", number)
        self._show_length()

    def _show_length(self) -> None:
        number = self.tool.currentData()
        self.length.show_length(0.0 if number is None else self._lengths.get(number, self._posted[number]))

    def _take_length(self) -> None:
        number, length = self.tool.currentData(), self.length.length() or 0.0
        if number is None:
            return
        self._lengths.pop(number, None)
        if 0.0 < length <= LONGEST_TOOL and length != self._posted[number]:
            self._lengths[number] = length
        self._show_length()

    def offsets(self) -> MachineOffsets:
        """The changes since posting."""
        x, y, z = (float(field.property("rawValue")) for field in self.shift.values())
        return MachineOffsets((x, y, z), dict(self._lengths))

    def preparation(self, trajectory: Trajectory, without: Trajectory | None, machine: Machine) -> Callable[[], Ready]:
        """A call for any thread that reads the solids and applies the offsets, or raises why it cannot.

        Args:
            trajectory: as posted.
            without: the same program without its ``/`` blocks; None if there is none.
        """
        one = {name: next(iter(self.solids[name].files), None) for name in ("part", "stock")}
        files, offsets = MeshFiles(**one, fixtures=self.solids["fixtures"].files), self.offsets()

        def prepare() -> Ready:
            setup, diagnostics = effective_setup(Options(mesh_files=files), None)
            moved, found = with_machine_offsets(trajectory, machine, offsets)
            skipped, also = (None, ()) if without is None else with_machine_offsets(without, machine, offsets)
            diagnostics += (*found, *also)
            for made in (moved, skipped):
                diagnostics += () if made is None else collisions_at_offsets(made, machine, offsets, setup)
            if moved is None or errors(diagnostics):
                raise Refused(diagnostics)
            return Ready(moved, skipped, setup, diagnostics)

        return prepare


def trajectory_kinds() -> str:
    """The dialog filter for trajectories."""
    kinds = translate("ControlPanel", "Trajectories")
    return f"{kinds} (*.pkmt)"
