# SPDX-License-Identifier: LGPL-2.1-or-later
"""Codes: the supported G and M codes, their modal groups, and the words they use.

Tables only; G codes in tenths (434 is G43.4). A block may have one code per group. The groups are those of RS274NGC
[LinuxCNC, G codes, modal groups], plus a group each for G68 and G51.1, which it lacks.
"""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

NONE = -1
"""Marks a block without a code of a group."""


class Group(Enum):
    """Groups of mutually exclusive codes; the value is the name used in messages."""

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
    POLAR = "polar coordinates"
    MIRROR = "mirror"
    SCALING = "scaling"
    STOP = "stop"
    CHANGE = "tool change"
    SPINDLE = "spindle"
    COOLANT = "coolant"
    OVERRIDE = "overrides"
    FUNCTION = "functions of the machine"


class Code(NamedTuple):
    """Definition of a code.

    Attributes:
        group: its modal group.
        letters: optional words, in addition to those that any block accepts.
        needs: required words.
        takes_axes: whether it consumes the axis words of the block instead of the motion.
    """

    group: Group
    letters: str = ""
    needs: str = ""
    takes_axes: bool = False


_DRILL = "XYZ@^RLK"
WORK_OFFSETS = (540, 550, 560, 570, 580, 590, 591, 592, 593)
"""In order of the P word of G10."""
FURTHER_OFFSET, MOST_FURTHER_OFFSETS = -1000, 300
"""Code of G54.1 P0, from which later ones count down; and the number of these offsets."""
FURTHER_OFFSETS = tuple(FURTHER_OFFSET - number for number in range(1, MOST_FURTHER_OFFSETS + 1))
OFFSETS_OF_G10 = {2: (NONE, *WORK_OFFSETS[:6]), 20: (NONE, *FURTHER_OFFSETS)}
"""Codes by L and P of G10 on Fanuc's controls; P0 is the offset of all of them, and none of these [Fanuc, G10]."""

G_CODES: dict[int, Code] = {
    0: Code(Group.MOTION, "XYZ@^"),
    10: Code(Group.MOTION, "XYZ@^"),
    20: Code(Group.MOTION, "XYZ@^IJKRP"),
    30: Code(Group.MOTION, "XYZ@^IJKRP"),
    730: Code(Group.MOTION, _DRILL + "Q"),
    800: Code(Group.MOTION),
    810: Code(Group.MOTION, _DRILL),
    820: Code(Group.MOTION, _DRILL + "P"),
    830: Code(Group.MOTION, _DRILL + "Q"),
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
    **{code: Code(Group.SYSTEM) for code in WORK_OFFSETS},
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

SPEED_LIMIT = "the highest speed for constant cutting speed"
"""What S is with G92, and with the G50 of lathes [Fanuc]."""
UNSUPPORTED: dict[str, str] = {
    "G50": SPEED_LIMIT,
    "G5": "splines",
    "G5.1": "splines",
    "G5.2": "NURBS",
    "G5.3": "NURBS",
    "G7": "diameters of a lathe",
    "G15": "polar coordinates of Fanuc's controls; @ and ^ are understood, and G16 with --flavour fanuc",
    "G16": "polar coordinates of Fanuc's controls; @ and ^ are understood, and G16 with --flavour fanuc",
    **{f"G38.{kind}": "probing; pmac measure does it between programs" for kind in (2, 3, 4, 5)},
    **dict.fromkeys(("G7.1", "G107"), "interpolation on a cylinder"),
    **dict.fromkeys(("G12", "G13", "G150"), "circular pockets of Haas's controls"),
    "G12.1": "interpolation in polar coordinates",
    "G27": "checks of the reference point",
    "G29": "the way back from the reference point",
    "G31": "probing",
    "G37": "measuring of tools",
    **{f"G{side}.{kind}": "cutter compensation in space" for side in (41, 42) for kind in (2, 3, 4, 5, 6)},
    "G141": "cutter compensation in space",
    "G44": "negative length offsets",
    **{f"G{code}": "tool offsets of single moves" for code in (45, 46, 47, 48)},
    "G51": "scaling",
    **dict.fromkeys(("G53.1", "G54.1", "G154", "G234"), "it is understood with --flavour fanuc"),
    **dict.fromkeys(("G54.2", "G254"), "work offsets that follow rotary tables"),
    "G60": "approach from one side",
    "G63": "tapping mode",
    "G66.1": "macros after every block; G66 is understood",
    "G68.2": "tilted planes; they are understood with --flavour fanuc",
    "G68.3": "planes normal to the tool",
    "G68.4": "tilted planes within another one",
    "G70": "inches on some controls, holes on Haas's; G20 and --unit inch are understood",
    "G71": "mm on some controls, holes on Haas's; G21 is understood",
    "G72": "patterns of holes of Haas's controls",
    "G76": "threading cycles, and fine boring, which needs an oriented spindle",
    "G87": "back boring, which needs an oriented spindle",
    "G88": "boring with retraction by hand",
    "G96": "constant cutting speed",
    "G101": "mirror images of Haas's controls; G51.1 is understood",
    **{f"G{code}": "work offsets of Haas's controls; G154 P is understood" for code in range(110, 130)},
    "M19": "orienting the spindle; a machine that can has M19 in controller.codes.functions of its file",
    "M50": "switches of the feed override",
    "M51": "switches of the spindle override",
    "M52": "adaptive feed",
    "M53": "switches of the feed hold",
    "M61": "setting the tool number without a change",
    **{f"M{code}": "digital and analogue outputs" for code in (62, 63, 64, 65, 66, 67, 68)},
    **{f"M{code}": "saving and restoring modal states" for code in (70, 71, 72, 73)},
    "M97": "calls of a sequence number on Haas's controls; M98 of an O number is understood",
    "M198": "calls of a program in another memory; M98 is understood, with the folder in --subprograms",
}
"""Purpose of well-known unsupported codes."""

ORIENTED_STOP = 19
"""M19 stops the spindle at an angle, if the machine file has it: a machine function in the group of the
spindle [LinuxCNC, M19]."""
SPINDLE_SYNCHRONISED = ("G33", "G33.1", "G74", "G84")
"""Threading codes: thread cutting, rigid tapping, and left-hand and right-hand tapping."""

DRILLING = (730, 810, 820, 830, 850, 860, 890)
TAPPING = (740, 840)
"""Left-hand and right-hand tapping, on machines with the spindle as an axis."""
CYCLES = (*DRILLING, *TAPPING)
RIGID_TAP = 331
"""G33.1 of LinuxCNC: to a point and back, with the spindle as an axis."""
STROKES = (*CYCLES, RIGID_TAP)
"""Codes of more than one move."""
CANCEL_CYCLE = 800
ARCS = (20, 30)
TO_REFERENCE = (280, 300)
WORDS_OF_ANY_BLOCK = "FNSTO"


class Word(NamedTuple):
    """A word of a block, printed as written: X1, G43.4, A3=1; without a value any word of its name."""

    name: str
    value: float | None = None

    def __str__(self) -> str:
        if self.value is None:
            return self.name
        return f"{self.name}{'=' if self.name[-1].isdecimal() else ''}{self.value:g}"


def word_of(code: int, letter: str = "G") -> Word:
    """The word of a code: G43.4 for 434, M6 for 6."""
    if code < NONE:
        return Word(f"G54.1 P{FURTHER_OFFSET - code}")
    return Word(letter, code / 10 if letter == "G" else code)


def name_of(code: int, letter: str = "G") -> str:
    """A code as written."""
    return str(word_of(code, letter))
