# SPDX-License-Identifier: LGPL-2.1-or-later
"""Threads: requirements of a spindle as an axis on a program, and features it excludes.

Input: a program with threads, and the machine. Output: the highest feed on their rows, and diagnostics. A thread is
made of feed moves along the tool axis. A mirror image would need another tap, and a thread cut backwards would end
before it starts. Units: mm, mm/s.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import Array, dot, norm
from pkm_post.model import Amount, Diagnostic, Kind, Machine, Phrase, Program, threads

_SPEED_SHARE = 0.95
"""Planned share of the spindle's speed limit: the controller's cubics oscillate slightly about it."""
_ASIDE = 1e-6
"""mm, and of unit axes: rounding of work offsets."""


def thread_feeds(program: Program, machine: Machine) -> Array:
    """Highest feed on each row, (N,): infinite outside threads."""
    feed = np.full(len(program), np.inf)
    for thread in threads(program.events):
        if machine.spindle_axis is not None:
            feed[thread.first : thread.end] = _SPEED_SHARE * abs(thread.lead) * machine.spindle_axis.speed
    return feed


def thread_faults(program: Program, machine: Machine, tip_before: Array, axis_before: Array) -> Iterator[Diagnostic]:
    """Faults of the threads of a program.

    Args:
        program: in {M}.
        machine: with the axis of its spindle.
        tip_before: (N, 3) tips at the starts of the rows.
        axis_before: (N, 3) unit tool axes there.
    """
    found = threads(program.events)
    if found and machine.spindle_axis is None:
        yield Diagnostic(
            "K154", program.place(found[0].first), Phrase("lead {}", Amount(abs(found[0].lead), "mm", "g"))
        )
        return
    limits = thread_feeds(program, machine)
    for thread in found:
        rows = slice(thread.first, thread.end)
        way, axis = program.position[rows] - tip_before[rows], axis_before[rows]
        along = dot(way, axis)
        aside = norm(way - along[:, None] * axis)
        turned = norm(program.tool_axis[rows] - axis)
        wrong = (program.kind[rows] != Kind.LINE) | (aside > _ASIDE) | (turned > _ASIDE)
        if wrong.any():
            row = thread.first + int(np.argmax(wrong))
            yield Diagnostic("K155", program.place(row), f"{aside[row - thread.first]:.3g} mm aside")
        elif along[:1] > 0:
            yield Diagnostic("K155", program.place(thread.first), Phrase("it begins towards the spindle"))
        if (program.feed[rows] > limits[rows]).any():
            feeds = f"F{60 * program.feed[rows].max():g} mm/min, limited to {60 * limits[thread.first]:g}"
            yield Diagnostic("K156", program.place(thread.first), feeds)


def without_threads(program: Program, purpose: str) -> tuple[Diagnostic, ...]:
    """K157 for a program with threads where they are not supported.

    Args:
        program: any.
        purpose: its purpose, as text.
    """
    found = threads(program.events)
    return (Diagnostic("K157", program.place(found[0].first), purpose),) if found else ()
