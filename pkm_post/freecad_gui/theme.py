# SPDX-License-Identifier: LGPL-2.1-or-later
"""Theme: the colours of our own painting, for the user's light or dark theme.

FreeCAD's themes are style sheets, which do not change the application's palette. So the ground is read from a text
field, whose palette Qt sets from the sheet.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from PySide import QtCore, QtGui, QtWidgets


@dataclass(frozen=True)
class Theme:
    """Colours as CSS names.

    Attributes:
        ground: behind diagrams.
        ink: texts.
        faint: frames and grids.
        bad: texts of errors, readable on the ground.
        cursor: cursor of the present time.
        limit: limits of a quantity.
        bands: backgrounds of operations, every other one.
        band_ink: texts on the bands.
        struts: one per strut.
        axis: tool axes in the 3D view, whose ground also follows FreeCAD's theme.
    """

    ground: str
    ink: str
    faint: str
    bad: str
    cursor: str
    limit: str
    bands: tuple[str, str]
    band_ink: str
    struts: tuple[str, ...]
    axis: str
    is_dark: bool


_LIGHT = Theme(
    "#ffffff", "#000000", "#888a85", "#c80000", "#204a87", "#a40000", ("#b8cfe6", "#dbe4ec"), "#000000",
    ("#3465a4", "#cc0000", "#4e9a06", "#f57900", "#75507b", "#8f5902"), "#5c3566", is_dark=False,
)  # fmt: skip
_DARK = Theme(
    "#1b1b1b", "#eeeeec", "#888a85", "#ff7b72", "#e6e6e6", "#ff7b72", ("#31506f", "#44576a"), "#ffffff",
    ("#729fcf", "#ff6b6b", "#8ae234", "#fcaf3e", "#c99fd0", "#d9a55b"), "#d9a8e8", is_dark=True,
)  # fmt: skip
_DARK_BELOW = 128
"""Lightness of the ground, out of 255."""


def theme() -> Theme:
    """The colours for FreeCAD's current theme."""
    return _by_sheet(QtWidgets.QApplication.instance().styleSheet(), QtWidgets.QApplication.palette().cacheKey())


@lru_cache(maxsize=4)
def _by_sheet(_sheet: str, _palette: int) -> Theme:
    field = QtWidgets.QPlainTextEdit()
    field.ensurePolished()
    ground = field.palette().color(QtGui.QPalette.ColorRole.Base)
    field.deleteLater()
    return _DARK if ground.lightness() < _DARK_BELOW else _LIGHT


def standard_icon(name: str) -> QtGui.QIcon:
    """An icon of Qt, in ink on dark themes if it is grey: Qt draws these for light grounds.

    Args:
        name: of a ``QStyle.StandardPixmap``.
    """
    icon = QtWidgets.QApplication.style().standardIcon(getattr(QtWidgets.QStyle.StandardPixmap, name))
    size = icon.availableSizes()[-1] if icon.availableSizes() else QtCore.QSize(_ICON, _ICON)
    image = icon.pixmap(size).toImage().convertToFormat(QtGui.QImage.Format.Format_ARGB32)
    return QtGui.QIcon(_inked(image)) if theme().is_dark and _is_grey(image) else icon


_ICON = 32
_GREY = 24
"""Saturation up to which a pixel counts as grey, out of 255."""


def _is_grey(image: QtGui.QImage) -> bool:
    step = max(1, image.width() // 16)
    seen = [image.pixelColor(x, y) for x in range(0, image.width(), step) for y in range(0, image.height(), step)]
    return all(colour.alpha() < 128 or colour.saturation() < _GREY or colour.value() < _GREY for colour in seen)


def _inked(image: QtGui.QImage) -> QtGui.QPixmap:
    painter = QtGui.QPainter(image)
    painter.setCompositionMode(QtGui.QPainter.CompositionMode.CompositionMode_SourceIn)
    painter.fillRect(image.rect(), QtGui.QColor(theme().ink))
    painter.end()
    return QtGui.QPixmap.fromImage(image)
