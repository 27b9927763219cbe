# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dialects: table of the differences between the CL data of CAM systems.

Enters: the text of a file. Leaves: its dialect, detected by words unique to it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Dialect:
    """One dialect.

    Attributes:
        name: key in ``DIALECTS``.
        title: the CAM systems that write it.
        signs: regular expression for line starts unique to this dialect.
        hand: "right" or "left": sense of rotation of an arc about its given axis; "vote" if unknown.
        frames: major words that define the frame of the points; in other dialects such words are informative only.
        insert_is_tool: INSERT names the tool.
        pted: further points follow on separate lines, without GOTO, and comments may hold circles.
        tight_arcs_are_centre: an arc under CUTCOM too tight for the tool to follow as a contour proves that the points
            are the tool centre; in other dialects the tool may equally be too large.
    """

    name: str
    title: str
    signs: str
    hand: str
    frames: frozenset[str] = frozenset()
    insert_is_tool: bool = False
    pted: bool = False
    tight_arcs_are_centre: bool = False


DIALECTS: dict[str, Dialect] = {
    dialect.name: dialect
    for dialect in (
        Dialect("nx", "NX CLSF", r"TOOL PATH/|END-OF-PATH|PAINT/PATH|MSYS[ \t]*/|TLDATA[ \t]*/", "left",
                frozenset({"MSYS"}), pted=True),
        Dialect("creo", "Creo, Pro/ENGINEER NCL", r"\$\$\*[ \t]+Pro/CLfile|\$\$->|REMARK[ \t]*->", "right",
                frozenset({"CSYS"})),
        Dialect("catia", "CATIA aptsource",
                r"\$\$[ \t]*CATIA APT|\$\$\*CATIA0|\$\$[ \t]*OPERATION NAME[ \t]*:|TLON,GOFWD", "right",
                frozenset({"CATIA0"})),
        Dialect("solidworks", "SolidWorks CAM, CAMWorks APT", r"CSI_SET_|TRNTYP/|UNIT/", "right", insert_is_tool=True,
                tight_arcs_are_centre=True),
        Dialect("makino", "Makino FF APT-CL", r"PPRINT/APTCL-SPEC,MAKINO|PPRINT/BEGIN-SECTION", "left"),
        Dialect("apt", "NCL, APT", r"(?!)", "vote", frozenset({"MSYS", "CSYS", "CATIA0"}), pted=True),
    )
}  # fmt: skip
"""The dialects by name, the most specific ones first."""

_WHERE = 200_000
"""Characters of a file searched to detect its dialect."""


def detect(text: str) -> Dialect:
    """The dialect matched by most lines at the start of a text; "apt" if none matches."""
    head = text[:_WHERE]
    counts = {
        name: len(re.findall(rf"^[ \t]*(?:{dialect.signs})", head, re.MULTILINE | re.IGNORECASE))
        for name, dialect in DIALECTS.items()
    }
    best = max(counts, key=lambda name: counts[name])
    return DIALECTS[best if counts[best] else "apt"]
