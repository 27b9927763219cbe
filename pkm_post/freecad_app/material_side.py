# SPDX-License-Identifier: LGPL-2.1-or-later
"""Material side: on which side of its path an operation has the material, and the sense of its spindle.

Takes an operation of a CAM job; returns +1 (right), -1 (left) or 0 (unknown), from its properties. CAM's operations
define climb milling for a spindle that turns clockwise (M3): the material is then to the right of the path.
"""

from __future__ import annotations

from typing import Any

from Path.Base.Util import toolControllerForOp

NOT_STATED, LEFT, RIGHT = "Not stated", "Left", "Right"
SIDES = {NOT_STATED: 0, LEFT: -1, RIGHT: 1}
"""Choices of the property ``MaterialSide``."""

_CUT_MODES = {"Climb": 1, "Conventional": -1}
_SENSES = {"Forward": 1, "Reverse": -1}
_PROFILE = {("Outside", "CW"): 1, ("Outside", "CCW"): -1, ("Inside", "CCW"): 1, ("Inside", "CW"): -1}
"""Side of the contour and direction of CAM's profile operation; CAM reverses holes by itself."""
_ORDERS = ("Order", "CutPattern", "OffsetPattern", "ClearingPattern")
_ONE_WAY = ("One way", "Spiral", "Offset")
"""Pass patterns that keep the material on one side throughout."""


def is_symmetric(obj: Any) -> bool:
    """Whether an object is a mirrored or rotated operation."""
    return hasattr(getattr(obj, "Proxy", None), "matrices")


def material_side_of(obj: Any) -> int:
    """The side on which an operation has the material, as far as its properties state it.

    Args:
        obj: an operation; a mirrored or rotated one takes the side of its base, and so does a dress-up.
    """
    if is_symmetric(obj):
        return base_side(obj) * obj.Proxy.hand(obj)
    if hasattr(obj, "CutMode"):
        orders = [getattr(obj, name) for name in _ORDERS if hasattr(obj, name)]
        return _CUT_MODES.get(obj.CutMode, 0) if all(order in _ONE_WAY for order in orders) else 0
    if hasattr(obj, "Side") and hasattr(obj, "Direction"):
        return _PROFILE.get((str(obj.Side), str(obj.Direction)), 0)
    base = getattr(obj, "Base", None)
    return material_side_of(base) if hasattr(base, "Path") else 0


def base_side(obj: Any) -> int:
    """The side on which the base of a mirrored or rotated operation has the material."""
    stated = SIDES[obj.MaterialSide]
    return stated if stated or obj.Base is None else material_side_of(obj.Base)


def spindle_sense_of(obj: Any) -> int:
    """+1 if the tool controller of an operation turns the spindle clockwise (M3), -1 counterclockwise, 0 if stopped."""
    return _SENSES.get(getattr(toolControllerForOp(obj), "SpindleDir", ""), 0)
