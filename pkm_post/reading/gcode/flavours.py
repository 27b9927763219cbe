# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flavours: differences in meaning of G-code between two families of controls, in one table.

Input: nothing. Output: ``FLAVOURS``; its rows are the differences, with their sources in docs/g-code.md. The reader
queries properties of the flavour, never its name, so that a further family is just another row.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from pkm_post.reading.gcode.codes import (
    ARCS,
    DRILLING,
    FURTHER_OFFSETS,
    G_CODES,
    M_CODES,
    NONE,
    ORIENTED_STOP,
    RIGID_TAP,
    TAPPING,
    UNSUPPORTED,
    Code,
    Group,
)
from pkm_post.reading.gcode.options import ReadOptions


class Flavour(NamedTuple):
    """Meaning of codes and words in a family of controls, where families differ; LinuxCNC's by default.

    Attributes:
        name: as given by the user.
        title: title of the language.
        dwell_unit: unit of P of G4 and of cycles, a key of ``DWELL_UNITS``.
        exact_stop: code, in tenths, under which the motion stops at the end of every block.
        exact_path: code, in tenths, under which corners are followed exactly; NONE if there is none.
        g80_restores_motion: whether G80 restores G0 to G3 from before the cycle, rather than no motion.
        keeps_cycle_words: whether R, depth, Q and P last until the series ends, rather than one cycle.
        cycle_dwells: cycles that dwell at the bottom.
        needs_dwell: whether these need P, except tapping cycles.
        feeds_to_r: cycles that retract at feed to R, then at rapid; others continue at feed.
        stores_cycle: whether a cycle repeated 0 times only stores its words.
        pecks_by_i: whether I, J and K of G73 and G83 are the first peck, the reduction, and the smallest.
        moves_beside_reference: whether G0 to G3 may share a block with G28 and G30, which take the axis words.
        may_drill_along_z: whether some controls drill along Z in G18 and G19 as well.
        g53_is_rapid: whether G53 moves at rapid whatever the active motion.
        offsets_add_up: whether G10 L2 adds to an offset under G91; then L20 sets those of G54.1, and no P is in force.
        one_local_offset: whether G52 and G92 set one offset, rather than two that add up.
        keeps_offset_number: whether D and H last until the next one, and D0 is no offset, not the tool's own.
        may_select_next: whether T beside M6 may select the next tool, while that of an earlier T is loaded.
        stops_first: whether M5 acts before the move of its block, rather than whenever the machine's builder decided.
        turns_about_tool: whether G68 without a centre turns about the tool; elsewhere it may be the origin as well.
        needs_both_after_turns: whether controls differ in the first move after G68 that has one coordinate of its
            plane, and in one by distances after G69.
        outside_turns: codes, in tenths, that controls read differently, or forbid, while a G68 rotation is in force.
        owns_axes: codes, in tenths, to which the axis words of their block belong, without a motion.
        counts_in_p: whether P of M98 with more than four digits starts with the number of passes.
        programs_apart: whether an O number starts another program, entered only by a call.
        counts_thousandths: whether some controls read lengths without a point as thousandths.
        restarts: whether M99 restarts the main program, and M99 P jumps to a sequence number.
        macros: whether G65 and G66 call programs with arguments, and variables may be vacant.
        equivalents: codes, in tenths, with the same meaning as another one.
        without_motion: codes without effect here: they cancel modes that this reader never activates.
        requests: codes that request smoothing from the control, with its description.
        silent_m: M codes without effect here.
        words_dropped: words of the codes without effect here; others beside them are faults.
        g_codes, m_codes: all supported codes.
        unsupported: known but refused codes, with the reason.
    """

    name: str = "rs274"
    title: str = "RS274NGC, as LinuxCNC has it"
    dwell_unit: str = "s"
    exact_stop: int = 611
    exact_path: int = 610
    g80_restores_motion: bool = False
    keeps_cycle_words: bool = False
    cycle_dwells: tuple[int, ...] = (820, 860, 890, *TAPPING)
    needs_dwell: bool = True
    feeds_to_r: tuple[int, ...] = (850,)
    stores_cycle: bool = False
    pecks_by_i: bool = False
    moves_beside_reference: bool = False
    may_drill_along_z: bool = False
    g53_is_rapid: bool = False
    offsets_add_up: bool = False
    one_local_offset: bool = True
    keeps_offset_number: bool = False
    may_select_next: bool = False
    stops_first: bool = True
    turns_about_tool: bool = False
    needs_both_after_turns: bool = False
    outside_turns: tuple[int, ...] = ()
    owns_axes: tuple[int, ...] = ()
    counts_in_p: bool = False
    programs_apart: bool = False
    counts_thousandths: bool = False
    restarts: bool = False
    macros: bool = False
    equivalents: Mapping[int, int] = {}
    without_motion: Mapping[int, str] = {80: "radius mode of lathes, the default", 500: "end of scaling"}
    requests: Mapping[int, str] = {}
    silent_m: Mapping[int, str] = {}
    words_dropped: Mapping[int, str] = {}
    g_codes: Mapping[int, Code] = G_CODES
    m_codes: Mapping[int, Code] = M_CODES
    unsupported: Mapping[str, str] = UNSUPPORTED

    def axis_takers(self) -> list[int]:
        """Codes that consume the axis words of their block."""
        return [code for code, meaning in self.g_codes.items() if meaning.takes_axes]


RS274 = Flavour()

_SMOOTHING = "smoothing"
_FANUC_CODES: dict[int, Code] = {
    **{code: meaning for code, meaning in G_CODES.items() if code not in (281, 301, 431, 432, 922, 923)},
    40: Code(Group.ONCE, "PX", takes_axes=True),
    921: Code(Group.ONCE, "XYZ", takes_axes=True),
    **{code: G_CODES[code]._replace(letters=G_CODES[code].letters.replace("P", "")) for code in ARCS},
    90: Code(Group.ONCE),
    **{code: Code(Group.POLAR) for code in (150, 160)},
    300: G_CODES[300]._replace(letters="XYZP"),
    531: Code(Group.ONCE, "P"),
    500: Code(Group.SCALING),
    510: Code(Group.SCALING, "XYZIJKP", takes_axes=True),
    541: Code(Group.SYSTEM, "P", "P"),
    682: Code(Group.ROTATION, "XYZIJKPQR", takes_axes=True),
    **{code: Code(Group.SYSTEM) for code in FURTHER_OFFSETS},
    **{code: Code(Group.MOTION, "XYZRLKPQ") for code in DRILLING},
    **{code: Code(Group.MOTION, "XYZRLKPQIJ") for code in (730, 830)},
}
_ORIGINS = tuple(code for code, meaning in _FANUC_CODES.items() if meaning.group is Group.SYSTEM)
_ONLY_HERE = ("G5", "G5.1", "G15", "G16", "G51", "G68.2", "M50", "M51")
_FANUC_REFUSED: dict[str, str] = {
    **{code: why for code, why in UNSUPPORTED.items() if code not in _ONLY_HERE},
    **dict.fromkeys(("G28.1", "G30.1", "G43.2", "G92.2", "G92.3"), "it is understood with --flavour rs274"),
    "G43.1": "tool length along a tilted axis without control of the tip; G43.4 is understood",
    "G76": "fine boring, which needs an oriented spindle",
}

FANUC = Flavour(
    name="fanuc",
    title="ISO code, as controls of Fanuc's kind have it",
    dwell_unit="ms",
    exact_stop=610,
    exact_path=NONE,
    g80_restores_motion=True,
    keeps_cycle_words=True,
    cycle_dwells=(820, 890, *TAPPING),
    needs_dwell=False,
    feeds_to_r=(850, 890),
    stores_cycle=True,
    pecks_by_i=True,
    moves_beside_reference=True,
    may_drill_along_z=True,
    g53_is_rapid=True,
    offsets_add_up=True,
    one_local_offset=False,
    keeps_offset_number=True,
    may_select_next=True,
    stops_first=False,
    turns_about_tool=True,
    needs_both_after_turns=True,
    outside_turns=(100, 170, 180, 190, 280, 300, 501, 511, 520, 530, 920, 921, *_ORIGINS),
    owns_axes=(51, 220),
    counts_in_p=True,
    programs_apart=True,
    counts_thousandths=True,
    restarts=True,
    macros=True,
    equivalents={2340: 434, 1540: 541},
    without_motion={
        131: "end of interpolation in polar coordinates",
        220: "stroke check",
        230: "end of the stroke check",
        250: "end of the watch of the spindle",
        260: "watch of the spindle",
        401: "end of normal direction",
        491: "end of a tool length",
        670: "end of a modal macro",
        1030: "limit of the blocks read ahead",
        2550: "end of an offset of the work",
    },
    requests={50: _SMOOTHING, 51: _SMOOTHING, 80: _SMOOTHING, 611: _SMOOTHING, 620: "slower corners", 1870: _SMOOTHING},
    silent_m={29: "rigid tapping: G74 and G84 are rigid, or refused"},
    words_dropped={50: "P", 51: "QR", 80: "P", 260: "PQR", 1030: "P", 1870: "PE"},
    g_codes=_FANUC_CODES,
    unsupported=_FANUC_REFUSED,
)


FLAVOURS: dict[str, Flavour] = {flavour.name: flavour for flavour in (RS274, FANUC)}
"""Flavours by name."""


def flavour_on_machine(options: ReadOptions) -> Flavour:
    """The flavour of the options with the M codes of the machine, and rigid tapping if its spindle can be an axis."""
    flavour = FLAVOURS[options.flavour or RS274.name]
    own = {code: Code(Group.SPINDLE if code == ORIENTED_STOP else Group.FUNCTION) for code in options.functions}
    flavour = flavour._replace(m_codes={**own, **flavour.m_codes})
    if not options.spindle_axis:
        return flavour
    words = flavour.g_codes[820].letters.replace("Q", "")
    taps = {code: Code(Group.MOTION, words) for code in TAPPING}
    if flavour.name == RS274.name:
        taps[RIGID_TAP] = Code(Group.MOTION, "XYZK", "K")
    return flavour._replace(g_codes={**flavour.g_codes, **taps})
