# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress: what a long computation shows while it runs, and how its user stops it.

A text and a number of steps enter; FreeCAD's progress bar moves, or percentages appear in the console, and ``Stopped``
leaves when the user pressed Escape. While a document recomputes, the bar is that of the document, and FreeCAD leaves
every other one without effect. So in a window the share done is told in the status bar as well, and Escape is watched
by ourselves.
"""

from __future__ import annotations

import importlib
from types import TracebackType
from typing import Any, Self

import FreeCAD as App
from FreeCAD import Base

translate = App.Qt.translate

_WATCH = "pkm_post.freecad_gui.escape_watch"
"""The watch is a floor above: it is named and not imported."""


class Stopped(Exception):  # noqa: N818 - it is no error of the program
    """The user stopped the computation; what it was for is not done."""


class Progress:
    """A progress bar, as a context: ``with Progress("Normals", 12) as progress: progress.step()``.

    Args:
        text: what is being done, in a word or two.
        steps: how many times ``step`` will be called.
    """

    def __init__(self, text: str, steps: int) -> None:
        self._text, self._steps, self._done = text, max(steps, 1), 0
        self._bar = Base.ProgressIndicator()
        self._watch: Any = importlib.import_module(_WATCH).EscapeWatch() if App.GuiUp else None

    def __enter__(self) -> Self:
        self._bar.start(self._text, self._steps)
        if self._watch:
            self._watch.begin()
        return self

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, at: TracebackType | None) -> None:
        if self._watch:
            self._watch.end()
        self._bar.stop()

    def step(self) -> None:
        """One more step is done.

        Raises:
            Stopped: the user pressed Escape since the last step.
        """
        self._done += 1
        share = f"{100 * self._done // self._steps} %"
        stopped = translate("Progress", "{}: stopped at {}").format(self._text, share)
        try:
            self._bar.next(True)
        except RuntimeError as stop:  # so FreeCAD tells that its own bar was stopped
            raise Stopped(stopped) from stop
        told = translate("Progress", "{}: {} done. Escape stops it.").format(self._text, share)
        if self._watch and self._watch.pressed(told):
            raise Stopped(stopped)
