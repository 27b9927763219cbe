# SPDX-License-Identifier: LGPL-2.1-or-later
"""Material side: on which side of its way an operation has the material, and how its spindle turns.

An operation of a CAM job enters; +1 (right), -1 (left) or 0 (not known) leaves, from what its properties say. CAM's
operations speak of climb milling for a spindle that turns clockwise (M3): the material is to the right of it then.
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
"""Side of the contour and direction of CAM's profile operation; holes are run the other way by itself."""
_ORDERS = ("Order", "CutPattern", "OffsetPattern", "ClearingPattern")
_ONE_WAY = ("One way", "Spiral", "Offset")
"""Orders of passes that have the material on one side all the time."""


def is_symmetric(obj: Any) -> bool:
    """Whether an object is a mirrored or turned operation."""
    return hasattr(getattr(obj, "Proxy", None), "matrices")


def material_side_of(obj: Any) -> int:
    """The side on which an operation has the material, as far as properties tell.

    Args:
        obj: an operation; a mirrored or turned one asks its base, a dress-up as well.
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
    """The side on which the base of a mirrored or turned operation has the material."""
    stated = SIDES[obj.MaterialSide]
    return stated if stated or obj.Base is None else material_side_of(obj.Base)


def spindle_sense_of(obj: Any) -> int:
    """+1 where the tool controller of an operation turns the spindle clockwise (M3), -1 the other way, 0 not at all."""
    return _SENSES.get(getattr(toolControllerForOp(obj), "SpindleDir", ""), 0)
