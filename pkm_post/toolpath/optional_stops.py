# SPDX-License-Identifier: LGPL-2.1-or-later
"""Optional stops: treatment of M1, for which a control has a switch.

Input: a program and the treatment of its optional stops. Output: the program with stops, without them, or unchanged,
and a line for the report about the change.
"""

from __future__ import annotations

from dataclasses import replace

from pkm_post.model import Event, EventKind, Program

WRITTEN, STOPS, LEFT_OUT = "written", "stop", "leave-out"
OPTIONAL_STOPS = (WRITTEN, STOPS, LEFT_OUT)
"""Written as the code of the machine file, so that the switch of the controller decides; written as program stops; left
out."""
_OPTIONAL, _ALWAYS = 1.0, 0.0


def with_optional_stops(program: Program, choice: str) -> Program:
    """Change the optional stops of a program, M1 or OPSTOP, by one of ``OPTIONAL_STOPS``.

    Raises:
        ValueError: unknown choice.
    """
    if choice not in OPTIONAL_STOPS:
        raise ValueError(f"optional stops: expected one of {', '.join(OPTIONAL_STOPS)}, got {choice!r}")
    number = sum(map(_is_optional, program.events))
    if choice == WRITTEN or not number:
        return program
    kept = (event for event in program.events if choice == STOPS or not _is_optional(event))
    events = tuple(replace(event, value=_ALWAYS) if _is_optional(event) else event for event in kept)
    fate = "written as program stops" if choice == STOPS else "left out"
    note = f"{number} optional stop{'s' * (number > 1)} {fate}, as chosen"
    return replace(program, events=events, reading=(*program.reading, note))


def _is_optional(event: Event) -> bool:
    return event.kind is EventKind.STOP and event.value == _OPTIONAL
