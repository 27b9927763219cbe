# SPDX-License-Identifier: LGPL-2.1-or-later
"""Animation: exports a motion as pictures, one by one or as one animated picture.

Takes a view, a function that shows an instant, and the instants; writes PNG files. Escape cancels it.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import FreeCAD
import numpy as np
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.progress import Progress, Stopped
from pkm_post.report import animate

translate = FreeCAD.Qt.translate

_PICTURES, _ANIMATION = (30.0, 1280, 720), (15.0, 800, 450)
"""Frame rate, width and height. An animation is one file, in which each picture is compressed separately."""

_STRIPS, _LEAST_STRIP, _STRIP = 20, 16, "#2e3436"
"""Share of the height and least height in pixels of the strip for the caption, and its colour."""


@dataclass(frozen=True)
class Animation:
    """Subject and settings of an animation.

    Attributes:
        show: shows an instant, s.
        now: the instant to restore afterwards, s.
        duration: of the motion, s.
        time_scale: seconds of motion per second of the animation.
        per_second: pictures per second of the animation.
        width: of a picture, pixels.
        height: of a picture, pixels.
        caption: the text for the shown instant, drawn along the lower edge.
    """

    view: Any
    show: Callable[[float], None]
    now: float
    duration: float
    time_scale: float
    per_second: float
    width: int
    height: int
    caption: Callable[[], str]

    def write_pictures(self, folder: Path) -> int:
        """Write frame_00001.png and so on; return their number, smaller after a cancel."""
        instants, written = np.arange(0.0, self.duration + 1e-9, self.time_scale / self.per_second), 0
        try:
            with Progress(translate("PKM_Simulate", "Pictures"), len(instants)) as bar:
                for number, seconds in enumerate(instants.tolist(), start=1):
                    self.show(seconds)
                    target = str(folder / f"frame_{number:05d}.png")
                    self.view.saveImage(target, self.width, self.height, "Current")
                    write_caption(target, self.caption())
                    written = number
                    bar.step()
        except Stopped:
            text = translate("PKM_Simulate", "{} of {} pictures were written")
            FreeCAD.Console.PrintWarning(text.format(written, len(instants)) + "\n")
        self.show(self.now)
        return written

    def write_animation(self, target: Path) -> int:
        """Write an animated PNG; return its number of pictures. A cancelled animation is written up to that point."""
        with tempfile.TemporaryDirectory() as folder:
            written = self.write_pictures(Path(folder))
            if written:
                animate(sorted(Path(folder).glob("*.png")), target, self.per_second)
        return written


def write_caption(picture: str, text: str) -> None:
    """Draw a line of text into a PNG file, light on a dark strip along its lower edge."""
    image = QtGui.QImage(picture).convertToFormat(QtGui.QImage.Format.Format_RGB32)
    height = max(image.height() // _STRIPS, _LEAST_STRIP)
    strip = QtCore.QRect(0, image.height() - height, image.width(), height)
    painter = QtGui.QPainter(image)
    font = painter.font()
    font.setPixelSize(round(0.6 * height))
    painter.setFont(font)
    painter.fillRect(strip, QtGui.QColor(_STRIP))
    painter.setPen(QtGui.QColor("white"))
    room = strip.adjusted(height // 2, 0, -height // 2, 0)
    shown = painter.fontMetrics().elidedText(text, QtCore.Qt.TextElideMode.ElideRight, room.width())
    painter.drawText(room, QtCore.Qt.AlignmentFlag.AlignVCenter, shown)
    painter.end()
    image.save(picture, "PNG")


Recorder = Callable[[float, int, int], Animation]
"""Creates an animation from pictures per second, width and height."""


def ask_for_pictures(parent: Any, record: Recorder) -> None:
    """Ask for the folder of the pictures, and write them."""
    folder = QtWidgets.QFileDialog.getExistingDirectory(parent, translate("PKM_Simulate", "Folder for the pictures"))
    if folder:
        record(*_PICTURES).write_pictures(Path(folder))


def ask_for_animation(parent: Any, record: Recorder, name: str) -> None:
    """Ask for the file of the animated picture, and write it."""
    title, kind = translate("PKM_Simulate", "Animated PNG"), translate("PKM_Simulate", "Animated PNG (*.png)")
    target, _ = QtWidgets.QFileDialog.getSaveFileName(parent, title, f"{name}.png", kind)
    if target:
        record(*_ANIMATION).write_animation(Path(target))
