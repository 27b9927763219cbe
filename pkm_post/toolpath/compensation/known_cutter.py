# SPDX-License-Identifier: LGPL-2.1-or-later
"""Known cutter: the shape of a tool where a contact point depends on it, or what is missing.

Takes a tool; returns its cutter, or a diagnostic that states what is missing. An error of the corner radius shifts the
tip by the same amount, so no radius is assumed.
"""

from __future__ import annotations

from pkm_post.model import Diagnostic, Place, Tool
from pkm_post.toolpath.compensation.cutter import Cutter


def known_cutter(tool: Tool, place: Place) -> tuple[Cutter | None, tuple[Diagnostic, ...]]:
    """The cutter of a tool whose diameter and corner radius are given.

    Args:
        tool: the tool.
        place: what diagnostics name.

    Returns:
        The cutter, or None; and diagnostics of what is unknown: N109, N117.
    """
    try:
        cutter = Cutter.of(tool)
    except ValueError as impossible:
        return None, (Diagnostic("N109", place, str(impossible)),)
    if not tool.corner_known:
        return None, (
            Diagnostic("N117", place, f"T{tool.number}, of which the diameter alone is given: {tool.diameter:g} mm"),
        )
    return cutter, ()
