# SPDX-License-Identifier: LGPL-2.1-or-later
"""Modal: which codes there are, the groups they belong to, and which code of each group is in force in each block.

Blocks enter, columns of codes leave, in tenths for G (434 is G43.4). Of one group a block may have one code; the
modal ones stay in force until another code of their group. The groups are those of RS274NGC [LinuxCNC, G codes,
modal groups], with a group each for G68 and G51.1, which it has not.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from pkm_post.gcode.blocks import Blocks, column_of
from pkm_post.model.program import Array

NONE = -1
"""Stands where a block has no code of a group."""


class Group(Enum):
    """Codes that exclude each other; the value is their name in messages."""

    ONCE = "codes that act once"
    MOTION = "motion"
    PLANE = "plane"
    DISTANCE = "distance mode"
    ARC_DISTANCE = "arc distance mode"
    FEED_MODE = "feed mode"
    UNIT = "units"
    SIDE = "cutter compensation"
    LENGTH = "tool length offset"
    RETRACT = "retract mode"
    SYSTEM = "work offset"
    PATH = "path control"
    SPINDLE_MODE = "spindle mode"
    ROTATION = "rotation"
    MIRROR = "mirror"
    STOP = "stop"
    CHANGE = "tool change"
    SPINDLE = "spindle"
    COOLANT = "coolant"
    OVERRIDE = "overrides"


@dataclass(frozen=True)
class Code:
    """What a code is.

    Attributes:
        group: the codes it excludes.
        letters: words it can have beside those that every block can have.
        needs: words it must have.
        takes_axes: whether the axis words of the block are its own and no motion's.
    """

    group: Group
    letters: str = ""
    needs: str = ""
    takes_axes: bool = False


_DRILL = "XYZRL"
_SYSTEMS = (540, 550, 560, 570, 580, 590, 591, 592, 593)

G_CODES: dict[int, Code] = {
    0: Code(Group.MOTION, "XYZ"),
    10: Code(Group.MOTION, "XYZ"),
    20: Code(Group.MOTION, "XYZIJKRP"),
    30: Code(Group.MOTION, "XYZIJKRP"),
    730: Code(Group.MOTION, _DRILL + "Q"),
    800: Code(Group.MOTION),
    810: Code(Group.MOTION, _DRILL),
    820: Code(Group.MOTION, _DRILL + "P"),
    830: Code(Group.MOTION, _DRILL + "Q"),
    840: Code(Group.MOTION, _DRILL + "P"),
    850: Code(Group.MOTION, _DRILL),
    860: Code(Group.MOTION, _DRILL + "P"),
    890: Code(Group.MOTION, _DRILL + "P"),
    40: Code(Group.ONCE, "P", "P"),
    100: Code(Group.ONCE, "LPXYZR", "LP", takes_axes=True),
    280: Code(Group.ONCE, "XYZ", takes_axes=True),
    281: Code(Group.ONCE),
    300: Code(Group.ONCE, "XYZ", takes_axes=True),
    301: Code(Group.ONCE),
    520: Code(Group.ONCE, "XYZ", takes_axes=True),
    530: Code(Group.ONCE),
    920: Code(Group.ONCE, "XYZ", takes_axes=True),
    921: Code(Group.ONCE),
    922: Code(Group.ONCE),
    923: Code(Group.ONCE),
    **{code: Code(Group.PLANE) for code in (170, 180, 190)},
    **{code: Code(Group.DISTANCE) for code in (900, 910)},
    **{code: Code(Group.ARC_DISTANCE) for code in (901, 911)},
    **{code: Code(Group.FEED_MODE) for code in (930, 940, 950)},
    **{code: Code(Group.UNIT) for code in (200, 210)},
    400: Code(Group.SIDE),
    **{code: Code(Group.SIDE, "D") for code in (410, 420)},
    **{code: Code(Group.SIDE, "D", "D") for code in (411, 421)},
    **{code: Code(Group.LENGTH, "H") for code in (430, 434, 435)},
    431: Code(Group.LENGTH, "XYZ", takes_axes=True),
    432: Code(Group.LENGTH, "H", "H"),
    490: Code(Group.LENGTH),
    **{code: Code(Group.RETRACT) for code in (980, 990)},
    **{code: Code(Group.SYSTEM) for code in _SYSTEMS},
    **{code: Code(Group.PATH) for code in (610, 611)},
    640: Code(Group.PATH, "PQ"),
    970: Code(Group.SPINDLE_MODE),
    680: Code(Group.ROTATION, "XYZR", "R", takes_axes=True),
    690: Code(Group.ROTATION),
    501: Code(Group.MIRROR, "XYZ", takes_axes=True),
    511: Code(Group.MIRROR, "XYZ", takes_axes=True),
}

M_CODES: dict[int, Code] = {
    **{code: Code(Group.STOP) for code in (0, 1, 2, 30, 60)},
    6: Code(Group.CHANGE),
    **{code: Code(Group.SPINDLE) for code in (3, 4, 5)},
    **{code: Code(Group.COOLANT) for code in (7, 8, 9)},
    **{code: Code(Group.OVERRIDE) for code in (48, 49)},
}

REFUSED: dict[str, str] = {
    "G5": "splines",
    "G5.1": "splines",
    "G5.2": "NURBS",
    "G5.3": "NURBS",
    "G7": "diameters of a lathe",
    "G15": "polar coordinates",
    "G16": "polar coordinates",
    "G33": "motion in step with the spindle",
    "G33.1": "tapping in step with the spindle",
    "G38.2": "probing",
    "G38.3": "probing",
    "G38.4": "probing",
    "G38.5": "probing",
    "G44": "negative length offsets",
    "G50": "scaling",
    "G51": "scaling",
    "G68.2": "tilted planes",
    "G74": "tapping with a left-hand tap",
    "G76": "threading cycles",
    "G87": "back boring, which needs an oriented spindle",
    "G88": "boring with retraction by hand",
    "G96": "constant cutting speed",
    "M19": "orienting the spindle",
    "M50": "switches of the feed override",
    "M51": "switches of the spindle override",
    "M52": "adaptive feed",
    "M53": "switches of the feed hold",
    "M61": "setting the tool number without a change",
    **{f"M{code}": "digital and analogue outputs" for code in (62, 63, 64, 65, 66, 67, 68)},
    **{f"M{code}": "saving and restoring modal states" for code in (70, 71, 72, 73)},
}
"""What well-known codes are for that no program for this machine can have."""

_DEFAULTS: dict[Group, int] = {
    Group.MOTION: 800,
    Group.PLANE: 170,
    Group.DISTANCE: 900,
    Group.ARC_DISTANCE: 911,
    Group.FEED_MODE: 940,
    Group.UNIT: 210,
    Group.SIDE: 400,
    Group.LENGTH: 490,
    Group.RETRACT: 980,
    Group.PATH: 640,
    Group.SYSTEM: 540,
}
"""What is in force before a program says anything."""

CYCLES = (730, 810, 820, 830, 840, 850, 860, 890)
ARCS = (20, 30)
ANY_BLOCK = "FNSTO"


def name_of(code: int, letter: str = "G") -> str:
    """A code as it is written: G43.4 for 434, M6 for 6."""
    return f"{letter}{code / 10:g}" if letter == "G" else f"{letter}{code}"


def owners(start: Array) -> Array:
    """The block of every code, (K,), from the (N + 1,) bounds of the blocks."""
    return np.repeat(np.arange(len(start) - 1), np.diff(start))


def latest(given: Array) -> Array:
    """The last row up to each row that is given, (N,); -1 before the first."""
    return np.maximum.accumulate(np.where(given, np.arange(len(given)), -1)) if len(given) else np.zeros(0, np.int64)


def carried(values: Array, given: Array, before: float) -> Array:
    """Each value or else the last one given, (N,)."""
    index = latest(given)
    return np.where(index < 0, before, values[index]) if len(values) else values


@dataclass(frozen=True)
class Modal:
    """Codes by block.

    Attributes:
        explicit: by group, (N,) the code that stands in the block, ``NONE`` where none does. Of COOLANT, the last.
        in_force: by modal group, (N,) the code in force in the block, its own included.
        scale: (N,) mm in one unit of length.
        moves: (N,) whether the block moves the tool by the motion in force.
        takes_axes: (N,) the G code other than a motion that the axis words belong to, ``NONE`` where none.
    """

    explicit: dict[Group, Array]
    in_force: dict[Group, Array]
    scale: Array
    moves: Array
    takes_axes: Array


def modal_state(blocks: Blocks, unit: float, axis_letters: str) -> Modal:
    """The codes in force in every block.

    Args:
        blocks: plain blocks; codes that are not in the tables are left out.
        unit: mm in one unit of length before G20 or G21.
        axis_letters: the words that move the tool axis.
    """
    explicit = {group: np.full(len(blocks), NONE, dtype=np.int32) for group in Group}
    takes_axes = np.full(len(blocks), NONE, dtype=np.int32)
    for codes, owner, table in (
        (blocks.g, owners(blocks.g_start), G_CODES),
        (blocks.m, owners(blocks.m_start), M_CODES),
    ):
        for code in np.unique(codes):
            if int(code) in table:
                rows = owner[codes == code]
                explicit[table[int(code)].group][rows] = code
                if table[int(code)].takes_axes:
                    takes_axes[rows] = code
    in_force = {
        group: carried(explicit[group], explicit[group] != NONE, default) for group, default in _DEFAULTS.items()
    }
    inches = explicit[Group.UNIT]
    scale = carried(np.where(inches == 200, 25.4, 1.0), inches != NONE, unit)
    moves = _moves(blocks, explicit, in_force, axis_letters) & (takes_axes == NONE)
    return Modal(explicit, in_force, scale, moves, takes_axes)


def _moves(blocks: Blocks, explicit: dict[Group, Array], in_force: dict[Group, Array], axis_letters: str) -> Array:
    """Whether a block has words that make it move, (N,)."""
    motion = in_force[Group.MOTION]
    on_arc = np.isin(motion, ARCS)
    # Of an arc the centre or the radius is enough; G1 I J K turns the tool axis, but of an arc these are the centre.
    moves = _has(blocks, "XYZ" + axis_letters) | (on_arc & _has(blocks, "IJKR"))
    return moves | np.isin(explicit[Group.MOTION], CYCLES)


def _has(blocks: Blocks, letters: str) -> Array:
    """Whether a block has one of the words, (N,)."""
    given = np.zeros(len(blocks), dtype=np.bool_)
    for letter in letters:
        given |= ~np.isnan(blocks.words[:, column_of(letter)])
    return given
