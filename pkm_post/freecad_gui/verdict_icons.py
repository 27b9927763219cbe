# SPDX-License-Identifier: LGPL-2.1-or-later
"""Verdict icons: job and operations in the tree show the verdict of Reach, Simulation or a post, in green or red.

Takes the reach and simulation objects of a document; returns icons with a sign in a corner. CAM's view providers for
jobs and operations are extended before their first object exists: FreeCAD caches their ``getIcon`` at that time.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import lru_cache
from types import ModuleType
from typing import TYPE_CHECKING, Any

import FreeCAD
from PySide import QtCore, QtGui

from pkm_post.freecad_app.document import is_job, is_operation, job_of, members
from pkm_post.freecad_app.startup import when_imported

if TYPE_CHECKING:
    from pkm_post.model import Diagnostic

_SIZE, _SIGN = 64, 34
"""Pixels of an icon, and of the sign in its lower right corner."""
_COLOURS = {True: "#1b7f3b", False: "#b3261e"}
_STROKES = {
    True: ((0.25, 0.55), (0.43, 0.72), (0.76, 0.30)),
    False: ((0.30, 0.30), (0.70, 0.70), (0.50, 0.50), (0.30, 0.70), (0.70, 0.30)),
}
"""Lines of the tick and the cross, as shares of the sign, for users who cannot distinguish the colours."""
_OWNERS = {"Path.Op.Gui.Base": "Object", "Path.Main.Gui.Job": "obj"}
"""CAM's modules with a class ViewProvider, and its attribute for the displayed object."""
_ERROR = re.compile(r" error [A-Z]\d+: ")
"""Matches the stored text of a finding that prevents posting."""
_SAYS = {"Violations": ("Reachable", "Checks"), "ProblemTimes": ("Followable", "Blocks")}
"""By a property unique to Reach or Simulation: the properties of its verdict, and of results once computed."""
_ON_THE_MACHINE = ("K", "V")
"""Families of errors in the job; others are in files, arguments and operations without a path."""
_HARMLESS = ("Visibility", "LastPostProcessDate", "LastPostProcessOutput")
"""Properties of job, operations, tools and models that do not affect the posted program."""


@dataclass(frozen=True)
class _Post:
    """The last post of a job, dropped when the job changes.

    Attributes:
        of: names of the job and of all its dependencies.
        holds: whether it was certified; None while it is running.
        faulty: names of operations with an error.
    """

    of: frozenset[str]
    holds: bool | None = None
    faulty: frozenset[str] = frozenset()


_POSTS: dict[tuple[str, str], _Post] = {}
"""By names of document and job."""
_WATCHES: list[_Watch] = []


def install() -> None:
    """Extend CAM's view providers, now or when they are imported, and follow documents."""
    for module, attribute in _OWNERS.items():
        when_imported(module, _extension(attribute))
    if not _WATCHES:
        _WATCHES.append(_Watch())
        FreeCAD.addDocumentObserver(_WATCHES[0])


def keep_verdict(job: Any, findings: Iterable[Diagnostic] | None) -> None:
    """Store the verdict of a post on a job, until the job changes.

    Args:
        findings: of the post; None at its start: if the job changes before the end, they are discarded.
    """
    key = job.Document.Name, job.Name
    if findings is None:
        _POSTS[key] = _Post(frozenset({job.Name, *(each.Name for each in job.OutListRecursive)}))
    elif key in _POSTS:
        found = [each for each in findings if each.severity.value == "error"]
        if found and not any(each.code.startswith(_ON_THE_MACHINE) for each in found):
            del _POSTS[key]
        else:
            faulty = frozenset(each.place.operation for each in found)
            _POSTS[key] = replace(_POSTS[key], holds=not found, faulty=faulty)
    for watch in _WATCHES:
        watch.refresh_later(job.Document.Name)


def verdict_of(item: Any) -> bool | None:
    """Whether the machine can follow an item, by Reach, Simulation or a post; None if unknown.

    The item is a job, an operation, a Reach or a Simulation; unknown also while one of these waits for a recompute.
    """
    if item is None or not hasattr(item, "State") or _waits(item):
        return None
    if _knows(item):
        return _verdict_in(item)
    job = job_of(item) if is_job(item) or is_operation(item) else None
    known = [] if job is None else [each for each in job.InList if _knows(each) and each.Job == job and each.Active]
    post = None if job is None else _POSTS.get((job.Document.Name, job.Name))
    said = [verdict_of(each) for each in known] + ([] if post is None or post.holds is None else [post.holds])
    if None in said or not said:
        return None
    if is_job(item):
        return all(said)
    if getattr(item, "Active", True) is False or item not in members(job.Operations):
        return None
    named = post.faulty if post is not None else ()
    return not (any(_is_faulty(item, job, each) for each in known) or _is_named(item, job, named))


def _verdict_in(item: Any) -> bool | None:
    """The verdict that a Reach or a Simulation holds; None if it is switched off, or it or an input failed."""
    from pkm_post.freecad_app.document_checks import failed_input  # numpy is loaded by now, but not when FreeCAD starts

    holds, computed = _SAYS[next(name for name in _SAYS if hasattr(item, name))]
    known = getattr(item, computed) and item.Active and item.isValid() and not failed_input(item)
    return bool(getattr(item, holds)) if known else None


def _waits(item: Any) -> bool:
    """Whether an object, or its base operation, waits for a recompute."""
    while hasattr(item, "State"):
        if "Touched" in item.State:
            return True
        item = getattr(item, "Base", None)  # of a dress-up or a copy; faces of other operations have no state
    return False


def _knows(item: Any) -> bool:
    """Whether an object is a Reach or a Simulation."""
    return any(hasattr(item, name) for name in _SAYS)


def _is_faulty(operation: Any, job: Any, known: Any) -> bool:
    """Whether Reach or Simulation found an error in an operation."""
    if hasattr(known, "Violations"):
        found = zip(known.ViolationOperations, known.Violations, strict=False)
        names = {name for name, text in found if _ERROR.search(text)}
    else:
        names = set(known.WorstOperations)
    return _is_named(operation, job, names)


def _is_named(operation: Any, job: Any, names: Iterable[str]) -> bool:
    """Whether one of the operation names in programs is of this operation."""
    from pkm_post.freecad_app.fixtures import operation_named  # CAM is loaded by now, but not when FreeCAD starts

    return any(operation_named(job, name) == operation for name in names)


def with_verdict(icon: Any, item: Any) -> Any:
    """An icon, with a sign if the verdict on its object is known.

    Args:
        icon: the name of a file or a resource; other icons stay unchanged.
    """
    verdict = verdict_of(item)
    return icon if verdict is None or not isinstance(icon, str) else _signed(icon, verdict)


@lru_cache(maxsize=64)
def _signed(icon: str, verdict: bool) -> QtGui.QIcon:
    picture = QtGui.QPixmap(_SIZE, _SIZE)
    picture.fill(QtCore.Qt.GlobalColor.transparent)
    painter = QtGui.QPainter(picture)
    painter.setRenderHint(QtGui.QPainter.RenderHint.Antialiasing)
    QtGui.QIcon(icon).paint(painter, 0, 0, _SIZE, _SIZE)
    corner = _SIZE - _SIGN
    painter.setPen(QtCore.Qt.PenStyle.NoPen)
    painter.setBrush(QtGui.QColor(_COLOURS[verdict]))
    painter.drawEllipse(corner, corner, _SIGN, _SIGN)
    pen = QtGui.QPen(QtGui.QColor("white"))
    pen.setWidth(_SIGN // 7)
    painter.setPen(pen)
    painter.setBrush(QtCore.Qt.BrushStyle.NoBrush)
    points = [QtCore.QPointF(corner + x * _SIGN, corner + y * _SIGN) for x, y in _STROKES[verdict]]
    painter.drawPolyline(QtGui.QPolygonF(points))
    painter.end()
    return QtGui.QIcon(picture)


def _extension(attribute: str) -> Callable[[ModuleType], None]:
    def extend(module: ModuleType) -> None:
        provider = module.ViewProvider
        own = provider.getIcon
        if getattr(own, "has_verdict", False):
            return

        def getIcon(view: Any) -> Any:
            return with_verdict(own(view), getattr(view, attribute, None))

        getIcon.has_verdict = True  # type: ignore[attr-defined]
        provider.getIcon = getIcon

    return extend


class _Watch:
    """A document observer; FreeCAD calls its slots. It refreshes the icons of documents with verdicts."""

    def __init__(self) -> None:
        self._documents: set[str] = set()
        self._later = QtCore.QTimer()
        self._later.setSingleShot(True)
        self._later.timeout.connect(self._refresh)

    def refresh_later(self, document: str) -> None:
        """Refresh the icons of a document once FreeCAD is idle."""
        self._documents.add(document)
        self._later.start(0)

    def slotRecomputedDocument(self, document: Any) -> None:
        """The verdict may have changed."""
        if any(_knows(each) for each in document.Objects):
            self.refresh_later(document.Name)

    def slotDeletedDocument(self, document: Any) -> None:
        """Drop its posts: another document may get the name."""
        for key in [key for key in _POSTS if key[0] == document.Name]:
            del _POSTS[key]

    def slotChangedObject(self, item: Any, name: str) -> None:
        """Drop posts that depend on the object; refresh, since a touched object has no verdict."""
        if name not in _HARMLESS:
            here = item.Document.Name
            for key in [key for key, post in _POSTS.items() if key[0] == here and item.Name in post.of]:
                del _POSTS[key]
        if item.Document.Name in self._documents and not self._later.isActive():
            self._later.start(0)

    def slotDeletedObject(self, item: Any) -> None:
        """Treat a deletion as a change."""
        self.slotChangedObject(item, "")

    def _refresh(self) -> None:
        self._documents &= set(FreeCAD.listDocuments())
        for name in self._documents:
            for job in filter(is_job, FreeCAD.getDocument(name).Objects):
                for item in (job, *members(job.Operations), *filter(_knows, job.InList)):
                    item.ViewObject.signalChangeIcon()
