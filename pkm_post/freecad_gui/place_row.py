# SPDX-License-Identifier: LGPL-2.1-or-later
"""Place row: a button that searches for a place at which the machine can follow a job, and the result.

Takes a job, and the machine object for it; emits a signal when a place is found, and when the user accepts it. The
search runs in the background and shows its progress; Escape, its button, and closing the panel stop it.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.arguments import POST_PROCESSORS
from pkm_post.freecad_app.core_texts import exception_text, fault_text
from pkm_post.freecad_app.document import transaction
from pkm_post.freecad_app.job_setup import place_search, set_place
from pkm_post.freecad_app.progress import Stopped
from pkm_post.freecad_gui.background import BackgroundCall
from pkm_post.freecad_gui.observers import EscapeWatch
from pkm_post.freecad_gui.post_fields import push_button
from pkm_post.freecad_gui.verdict import Verdict
from pkm_post.model import Refused, errors
from pkm_post.posting import FoundPlace

translate = FreeCAD.Qt.translate

_PER_MILLE = 1000
_STILL = 0.05
"""mm and degrees: smaller amounts are not shown."""


class PlaceRow(QtWidgets.QWidget):
    """Search button, result, and the button to accept it.

    Attributes:
        found: the last place; None at first.
    """

    placed = QtCore.Signal()
    """A place was found, feasible or not."""
    taken = QtCore.Signal()
    """The user accepts the place."""

    def __init__(self, job: Any, machine_object: Any = None) -> None:
        super().__init__()
        self._job, self._machine, self._task = job, machine_object, None
        self._escape = EscapeWatch()
        self._escape.hit.connect(self._stop)
        self.found: FoundPlace | None = None
        self.bar = QtWidgets.QProgressBar()
        self.bar.setRange(0, _PER_MILLE)
        tip = translate("PlaceRow", "Stop the search, as Escape does")
        self.stop = push_button(translate("PlaceRow", "Stop"), self._stop, tip)
        tip = translate(
            "PlaceRow", "Search for a work offset, and if necessary another spin, with which the machine can follow"
        )
        self.search = push_button(translate("PlaceRow", "Find a place"), self._begin, tip)
        tip = translate("PlaceRow", "Set it as --work-offset, and --spin, in the arguments of the job")
        self.take = push_button(translate("PlaceRow", "Use this place"), self.taken.emit, tip)
        self.result = Verdict()
        layout = QtWidgets.QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        for part in (self.search, self.bar, self.stop, self.result, self.take):
            layout.addWidget(part)
        self.clear()

    def clear(self) -> None:
        """Show no place."""
        self.found = None
        self.result.say("")
        for part in (self.take, self.bar, self.stop):
            part.hide()

    def end(self) -> None:
        """Stop a running search, without showing a result."""
        if self._task is not None:
            self._task.finished.disconnect(self._done)
            self._task.finish()
            self._task = None
            self._escape.end()
            self.search.setEnabled(True)
        self.clear()

    def _stop(self) -> None:
        if self._task is not None:
            self._task.stop()

    def _begin(self) -> None:
        self.clear()
        try:
            search = place_search(self._job, self._machine)
        except (Refused, ReferenceError) as fault:  # FreeCAD says so of an object that was deleted
            self.result.say(exception_text(fault), holds=False)
            return
        task = BackgroundCall(lambda: search(task.report), self)
        self._task = task
        task.progressed.connect(lambda _step, share: self.bar.setValue(round(share * _PER_MILLE)))
        task.finished.connect(self._done)
        self.search.setEnabled(False)
        self.bar.setValue(0)
        for part in (self.bar, self.stop):
            part.show()
        self.result.say(translate("PlaceRow", "Looking for a place ..."))
        self._escape.begin()
        task.start()

    def _done(self) -> None:
        task, self._task = self._task, None
        self._escape.end()
        self.search.setEnabled(True)
        self.clear()
        try:
            self.found = task.value()
        except Stopped:
            self.result.say(translate("PlaceRow", "Stopped."))
            return
        except Refused as refused:
            self.result.say(exception_text(refused), holds=False)
            return
        self.result.say(place_text(self.found), self.found.holds)
        self.take.setVisible(self.found.holds and self._job.PostProcessor in POST_PROCESSORS)
        self.placed.emit()


def take_place(job: Any, found: FoundPlace) -> None:
    """Set a place in the arguments of a job, in one undo step, and recompute the document."""
    with transaction(job.Document, translate("PlaceRow", "Use this place")):
        set_place(job, found)
    job.Document.recompute()


def place_text(found: FoundPlace) -> str:
    """The amounts of a place and its effect, in the user's language and units."""
    shifted = translate("PlaceRow", "shift {amount} in {axis}")
    turned = translate("PlaceRow", "turn {amount} about {axis}")
    moves = [
        text.format(amount=_shown(value, unit), axis=axis)
        for text, values, unit in ((shifted, found.shift, "mm"), (turned, found.turn, "deg"))
        for axis, value in zip("xyz", values, strict=True)
        if abs(value) > _STILL
    ] or [translate("PlaceRow", "where it is")]
    if found.spins:
        moves.append(translate("PlaceRow", "spin optimised"))
    if not found.holds:
        missing = translate("PlaceRow", "No place was found. The last one tried: {}; there: {}")
        return missing.format(", ".join(moves), fault_text(errors(found.findings)[0]))
    spare = translate("PlaceRow", "{} to spare")
    left = [spare.format(_shown(value, unit[:3])) for unit, value in found.spare().items()]
    return translate("PlaceRow", "{}: the machine can follow, {}").format(", ".join(moves), ", ".join(left))


def _shown(value: float, unit: str) -> str:
    return str(FreeCAD.Units.Quantity(f"{value:.1f} {unit}").UserString)
