# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress: the progress display of a long computation, and its cancellation by the user.

Takes a text and a number of steps; moves FreeCAD's progress bar, or prints percentages to the console, and raises
``Stopped`` if the user pressed Escape. While a document recomputes, the bar belongs to the document, and FreeCAD
ignores every other one. In the GUI the completed share therefore also appears in the status bar, and Escape is watched
here.
"""

from __future__ import annotations

from types import TracebackType
from typing import Self

import FreeCAD as App
from FreeCAD import Base

from pkm_post.freecad_app.window import escape_watch

translate = App.Qt.translate


class Stopped(Exception):  # noqa: N818 - it is no error of the program
    """The user cancelled the computation; there is no result."""


class Progress:
    """A progress bar, as a context: ``with Progress("Normals", 12) as progress: progress.step()``.

    Args:
        text: description of the work, in a word or two.
        steps: number of calls of ``step``.
    """

    def __init__(self, text: str, steps: int) -> None:
        self._text, self._steps, self._done = text, max(steps, 1), 0
        self._bar = Base.ProgressIndicator()
        self._watch = escape_watch()

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
        """Report one more completed step.

        Raises:
            Stopped: the user has pressed Escape since the last step.
        """
        self._done += 1
        share = f"{100 * self._done // self._steps} %"
        stopped = translate("Progress", "{}: stopped at {}").format(self._text, share)
        try:
            self._bar.next(True)
        except RuntimeError as stop:  # raised by FreeCAD if its own bar was cancelled
            raise Stopped(stopped) from stop
        message = translate("Progress", "{}: {} done. Escape stops it.").format(self._text, share)
        if self._watch and self._watch.pressed(message):
            raise Stopped(stopped)
