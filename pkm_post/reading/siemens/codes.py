# SPDX-License-Identifier: LGPL-2.1-or-later
"""Codes: the G codes and names of Siemens's language that are read, noted or refused, with their meaning here.

Tables only. Sources: [SiemensNC], lists of G commands and of predefined procedures; a section in brackets otherwise.
"""

from __future__ import annotations

from collections.abc import Mapping


def _reasons(names: Mapping[str, str]) -> dict[str, str]:
    """Reasons by name, from the names by reason."""
    return {name: reason for reason, each in names.items() for name in each.split()}


_ADDRESSES = """
    CR AR AP RP TURN RPL ADIS ADISPOS CTOL OTOL FB DISC LEAD TILT THETA RND RNDM CHF CHR FRC FRCM ANG SPOS SPOSA DISR
    DISCL SF DITS DITE TCARR FD OVR OVRRAP LIMS SCC FGREF FXS PW SD NUT CTOLG0 OTOLG0 STOLF
"""
ADDRESSES = frozenset(_ADDRESSES.split())
"""Addresses of several letters; any other name before an equals sign is a variable."""

PLANES = {17: 170, 18: 180, 19: 190}
FEED_MODES = (93, 94, 95)
SIDES = {40: 0.0, 41: 1.0, 42: -1.0}
UNITS: dict[int, tuple[float, float | None]] = {70: (25.4, None), 71: (1.0, None), 700: (25.4, 25.4), 710: (1.0, 1.0)}
"""mm for each unit of lengths and of feeds; None keeps that of feeds [SiemensNC, inch or metric dimensions]."""
WORK_OFFSETS = frozenset({500, 54, 55, 56, 57, *range(505, 600)})
SUPPRESSED = frozenset({53, 153})
"""Codes that, like SUPA, suppress offsets in their block."""
SMOOTHING = (642, 643, 645)
"""Rounding with the contour tolerance CTOL [SiemensNC, CTOL]; G641 uses a distance, G644 the dynamics."""
CONTINUOUS = (64, 641, *SMOOTHING, 644)
EXACT_STOP, EXACT_STOP_ONCE = 60, 9

G_GROUPS = tuple(
    map(frozenset, (range(4), PLANES, (90, 91), FEED_MODES, SIDES, UNITS, WORK_OFFSETS, (EXACT_STOP, *CONTINUOUS)))
)
M_GROUPS = (frozenset({3, 4, 5}), frozenset({7, 9}), frozenset({8, 9}))
"""Codes of which a block may have one [SiemensNC, G groups]."""

_CORNERS = "the outer corners of compensated contours are planned here"
_APPROACH = "the approach to a compensated contour is planned here"
_DYNAMICS = "dynamics; here the machine file decides"
NOTED_G: dict[int, str] = {
    **dict.fromkeys((601, 602, 603), "when an exact stop is reached; here the motion rests"),
    **dict.fromkeys((450, 451), _CORNERS),
    **dict.fromkeys((460, 461, 462), _APPROACH),
    290: "Siemens's own language, which it is",
    21: "millimetres of ISO code, which are in force here",
    97: "spindle speed in revolutions per minute, which S is",
}
"""G codes without an effect here, with the reason."""

TAPPING_G = (33, 34, 35, 63, 331, 332)
REFUSED_G: dict[int, str] = {
    **dict.fromkeys((25, 26), "limits of working area and spindle"),
    **dict.fromkeys((58, 59), "programmable offsets of single axes"),
    74: "approach of the reference point",
    75: "approach of a fixed point",
    **dict.fromkeys((96, 961, 962, 971, 973), "constant cutting speed"),
    **dict.fromkeys((110, 111, 112), "poles of polar coordinates"),
    **dict.fromkeys((147, 148, 247, 248, 340, 341, 347, 348), "soft approach and retraction"),
    **dict.fromkeys((140, 141, 142, 143), "direction of soft approach"),
    291: "ISO code behind it; read the file with --flavour fanuc",
    **dict.fromkeys((931, 942, 952), "feeds of this kind"),
}

NOTED = _reasons({
    _DYNAMICS: "SOFT BRISK DRIVE SOFTA BRISKA DRIVEA JERKLIM JERKLIMA VELOLIM VELOLIMA ACC ACCLIMA FFWON FFWOF VFFCON"
    " DYNNORM DYNPOS DYNROUGH DYNSEMIFIN DYNFINISH DYNPREC",
    "curves for short lines; here the options of posting decide": "COMPON COMPCURV COMPCAD COMPSURF COMPPATH",
    "smoothing of the tool axis; here --axis-tolerance decides": "ORISON ORISOF ORIS OSC OSS OSSE OSOF OSD OST",
    "reference of the feed; here F is that of the tool tip": "FGROUP FGREF FNORM FLIN FCUB UPATH SPATH",
    "feed of compensated contours; here F is that of the contour": "CFC CFTCP CFIN",
    _APPROACH: "KONT KONTC KONTT NORM",
    "detection of bottlenecks, which is always done here": "CDON CDOF CDOF2",
    "blocks read ahead": "FIFOCTRL STARTFIFO STOPFIFO STOPRE PREPRO",
    "limits of the working area; here the reach is checked": "WALIMON WALIMOF",
    "way of rapid moves; here they are straight": "RTLION RTLIOF",
    "the tool axis takes the shortest way, as always here": "ORIPLANE ORIVECT ORIVIRT1",
    "even motion of the rotary axes; here the tool axis takes the shortest way between the blocks": "ORIAXES",
    "the tool axis is that of the workpiece": "ORIWKS",
    "the way of the tool axis in the frame of the machine; here it takes the shortest way between the blocks": "ORIMKS",
    "tool axis and path change together": "ORIC",
    "single axes and spindles": "FL FA ATOL OVRA SETMS",
    "overrides, and tolerances of the tool axis and of rapid moves": "OVR OVRRAP OTOL OTOLG0 CTOLG0 STOLF LIMS FD",
    "a distance from the corner and no tolerance; here --tip-tolerance decides": "ADIS ADISPOS",
    _CORNERS: "DISC",
})  # fmt: skip
"""Names without an effect here, with the reason; they are listed in the report."""

_SILENT = """
    MSG WORKPIECE GROUP_BEGIN GROUP_END GROUP_ADDEND DISPLOF DISPLON SBLOF SBLON SAVE SETAL CUT2D DIAMOF TOROTOF PAROTOF
    COMPOF TCOFR NEWCONF CLEARM GETT ACTBLOCNO
"""
SILENT = frozenset(_SILENT.split())
"""Names that do not affect the tool path on any control."""

NOTED_ELEMENTS = frozenset({*NOTED, *SILENT})
"""Names whose arguments or elements are skipped."""

_MILLING = "milling cycles; let the CAM system write the moves"
REFUSED = _reasons({
    "rotation by solid angles; ROT and AROT are read": "ROTS AROTS CROTS",
    "a frame along the tool": "TOROT TOFRAME TOROTX TOROTY TOROTZ TOFRAMEX TOFRAMEY TOFRAMEZ",
    "orientable tool carriers; CYCLE800 is read": "PAROT TCARR TCOABS",
    "a tool axis relative to path and surface; A3= B3= C3= are read": "LEAD TILT A4 B4 C4 A5 B5 C5",
    "ways of the tool axis but the shortest one": "ORIPATH ORIPATHS ORICONCW ORICONCCW ORICONIO ORICONTO ORICURVE",
    "rotation of the tool about itself": "ORIROTA ORIROTR ORIROTT ORIROTC THETA",
    "this notation of the tool axis": "ORID ORIVIRT2 ORIAXPOS ORIRPY2 NUT A6 B6 C6 A7 B7 C7",
    "roundings and chamfers between blocks": "RND RNDM CHF CHR FRC FRCM",
    "angles and polar coordinates of contours": "ANG AP RP",
    "soft approach and retraction": "DISR DISCL",
    "orienting the spindle": "SPOS SPOSA M19 SPCON",
    "splines and polynomials": "ASPLINE BSPLINE CSPLINE POLY PO PL PW SD",
    "involutes": "INVCW INVCCW",
    "transformations other than TRAORI": "TRACYL TRANSMIT TRAANG TRACON",
    "compensation in space; LN of G-code has surface normals": "CUT3DC CUT3DF CUT3DFF CUT3DFS CUT3DCC CUT2DF CUT2DD",
    "subprograms by path; those of the same file are read": "EXTCALL CALL PCALL ISOCALL CALLPATH",
    "synchronised actions": "WHEN WHENEVER EVERY ID IDS FROM DO",
    "measuring": "MEAS MEAW MEASA CYCLE976 CYCLE977 CYCLE978",
    "diameters of a lathe": "DIAMON DIAM90",
    "allowances and offsets of the tool": "OFFN TOFFL TOFFR TOFF",
    "lifting off": "POLF LFON LFTXT LFWP SETINT",
    "boring with an oriented spindle or by hand": "CYCLE86 CYCLE87 CYCLE88",
    _MILLING: "CYCLE61 CYCLE62 CYCLE63 CYCLE64 CYCLE70 CYCLE71 CYCLE72 CYCLE76 CYCLE77 CYCLE78 CYCLE79 CYCLE90 CYCLE899"
    " POCKET1 POCKET2 POCKET3 POCKET4 SLOT1 SLOT2 LONGHOLE",
    "this pattern of holes; HOLES1 and HOLES2 are read": "CYCLE801 CYCLE802 CYCLE60",
})  # fmt: skip
"""Unsupported names that change the motion, with the reason."""

TAPPING = frozenset({"CYCLE840", "CYCLE97", "CYCLE98", "CYCLE99"})

SILENT_M = frozenset({40, 41, 42, 43, 44, 45, 70})
"""M codes of gears and of the spindle as an axis, which move no tool."""
