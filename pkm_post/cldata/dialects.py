# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dialects: in what the CL data of CAM systems differ, as a table.

Enters: the text of a file. Leaves: the dialect it is written in, by the words that this dialect alone has.
"""

from __future__ import annotations

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Dialect:
    """One dialect.

    Attributes:
        name: key in ``DIALECTS``.
        title: the programs that write it.
        signs: regular expression of what is found at the start of a line in this dialect alone.
        hand: "right" or "left": how an arc turns about the axis that is given with it; "vote" where it is not known.
        frames: major words that say the frame the points are given in; in others such words are for information.
        insert_is_tool: INSERT names the tool.
        pted: points follow on lines of their own, without GOTO, and comments may hold circles.
        tight_arcs_are_centre: an arc under CUTCOM that no tool of its size could follow beside shows that the points
            are the centre of the tool; in others it may as well be a tool that is too large.
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
"""The dialects by name, the most particular ones first."""

_WHERE = 200_000
"""Characters of a file in which its dialect shows."""


def detect(text: str) -> Dialect:
    """The dialect in which most lines at the start of a text are written; "apt" if none shows."""
    head = text[:_WHERE]
    counts = {
        name: len(re.findall(rf"^[ \t]*(?:{dialect.signs})", head, re.MULTILINE | re.IGNORECASE))
        for name, dialect in DIALECTS.items()
    }
    best = max(counts, key=lambda name: counts[name])
    return DIALECTS[best if counts[best] else "apt"]
