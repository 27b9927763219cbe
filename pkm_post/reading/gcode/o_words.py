# SPDX-License-Identifier: LGPL-2.1-or-later
"""O words: match the O words of a program before it is executed.

Input: the O words by row. Output: the jump targets of each O word, and the rows of the subprograms; or every unmatched
O word, with its row.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from pkm_post.reading.gcode.parameters import ExecutionFault
from pkm_post.reading.gcode.statements import MACRO_JUMPS, OWord

CLOSES: dict[str, str] = {
    "endsub": "sub",
    "endif": "if",
    "else": "if",
    "elseif": "if",
    "endwhile": "while",
    "endrepeat": "repeat",
}
"""O words that close or divide a construct, and the O word that must be open. ``while`` closes a ``do``."""

LOOPS = ("while", "do", "repeat")


@dataclass
class JumpTargets:
    """Jump targets of O words.

    Attributes:
        subs: by label, the row of ``sub``.
        programs: by label, the row of a bare O number.
        other_end: of ``sub``, ``while``, ``repeat``, and of ``endwhile``, ``endrepeat`` and a ``while`` that closes a
            ``do``, the row at the other end; of ``else`` and ``elseif`` the row of ``endif``.
        next_branch: of ``if`` and ``elseif`` the next ``elseif``, ``else`` or ``endif``.
        last_row: of ``break`` and ``continue`` the last row of their loop.
        closing: the rows of ``while`` that close a ``do``.
    """

    subs: dict[str, int] = field(default_factory=dict)
    programs: dict[str, int] = field(default_factory=dict)
    other_end: dict[int, int] = field(default_factory=dict)
    next_branch: dict[int, int] = field(default_factory=dict)
    last_row: dict[int, int] = field(default_factory=dict)
    closing: set[int] = field(default_factory=set)


@dataclass
class _Open:
    """An open construct: its keyword, label, row, the branches of an ``if``, the jumps out of a loop."""

    keyword: str
    label: str
    row: int
    branches: list[int] = field(default_factory=list)
    jumps: list[int] = field(default_factory=list)
    has_else: bool = False


class _Linker:
    """Links O words in one pass, with a stack of open constructs, outermost first.

    Open constructs are indexed by label, not searched: a program may nest thousands of O words.
    """

    def __init__(self) -> None:
        self.flow = JumpTargets()
        self.open: list[_Open] = []
        self.macro_loops: list[tuple[int, str]] = []
        self._subs: list[int] = []
        """Indices of the subprograms in ``open``."""
        self._depths: dict[tuple[str, str], list[int]] = {}
        """Indices in ``open`` by keyword and label."""

    def link(self, row: int, word: OWord) -> None:
        """Link one O word.

        Raises:
            ExecutionFault: the O word is unmatched.
        """
        keyword = word.keyword
        if keyword in ("call", "goto", "then"):
            return
        if keyword in MACRO_JUMPS and isinstance(word.label, str):
            self._link_macro_loop(row, keyword, word.label)
            return
        if not isinstance(word.label, str):
            raise ExecutionFault("G311", f"the label of {keyword} is computed", word.label.column)
        if keyword == "program":
            self._begin_program(row, word.label)
        elif keyword == "while" and self._closes_do(word.label):
            self.flow.closing.add(row)
            self._close(self._popped(), row)
        elif keyword in CLOSES:
            self._close_or_divide(row, keyword, word.label)
        else:
            _BEGIN.get(keyword, _Linker._begin)(self, row, keyword, word.label)

    def _link_macro_loop(self, row: int, keyword: str, label: str) -> None:
        """Link WHILE DO n and END n, which may be nested."""
        if keyword == "macro while":
            self.macro_loops.append((row, label))
            return
        if not self.macro_loops or self.macro_loops[-1][1] != label:
            raise ExecutionFault("G307", f"END {label} without WHILE DO {label}")
        begin, _ = self.macro_loops.pop()
        self.flow.other_end.update({begin: row, row: begin})

    def _begin_program(self, row: int, label: str) -> None:
        if self.open:
            raise ExecutionFault(
                "G312", f"O{_shown(label)} within O{_shown(self.open[-1].label)} {self.open[-1].keyword}"
            )
        if row and not (label.isdecimal() or label.startswith("<")):  # rs274 ignores a call without its keyword
            raise ExecutionFault("G311", f"O<{label}> without a keyword such as call or sub, behind the first block")
        _define(self.flow.programs, label, row)

    def _closes_do(self, label: str) -> bool:
        return bool(self.open) and (self.open[-1].keyword, self.open[-1].label) == ("do", label)

    def _push(self, row: int, keyword: str, label: str) -> None:
        self._depths.setdefault((keyword, label), []).append(len(self.open))
        if keyword == "sub":
            self._subs.append(len(self.open))
        self.open.append(_Open(keyword, label, row))

    def _popped(self) -> _Open:
        opened = self.open.pop()
        self._depths[opened.keyword, opened.label].pop()
        if opened.keyword == "sub":
            self._subs.pop()
        return opened

    def _begin(self, row: int, keyword: str, label: str) -> None:
        twice = any(self._first_within(each, label) is not None for each in ("if", *LOOPS))
        self._push(row, keyword, label)
        if twice:
            raise ExecutionFault("G310", f"O{_shown(label)} {keyword} within another O{_shown(label)}")

    def _begin_sub(self, row: int, keyword: str, label: str) -> None:
        self._push(row, keyword, label)
        if len(self._subs) > 1:
            raise ExecutionFault("G312", f"O{_shown(label)} sub within another sub")
        _define(self.flow.subs, label, row)

    def _jump(self, row: int, keyword: str, label: str) -> None:
        loops = [depth for loop in LOOPS if (depth := self._first_within(loop, label)) is not None]
        if not loops:
            raise ExecutionFault("G307", f"O{_shown(label)} {keyword}, outside of a loop of this label")
        self.open[min(loops)].jumps.append(row)

    def _return(self, row: int, keyword: str, label: str) -> None:
        """Link a return with any label: it ends the running subprogram [LinuxCNC, rs274]."""
        if not self._subs:
            raise ExecutionFault("G312", f"O{_shown(label)} {keyword} outside of a sub")

    def _first_within(self, keyword: str, label: str) -> int | None:
        """Index of the outermost such construct that is open within the current subprogram."""
        depths = self._depths.get((keyword, label), [])
        first = bisect_left(depths, self._subs[-1]) if self._subs else 0
        return depths[first] if first < len(depths) else None

    def _close_or_divide(self, row: int, keyword: str, label: str) -> None:
        depths = self._depths.get((CLOSES[keyword], label))
        if not depths:
            raise ExecutionFault("G307", f"O{_shown(label)} {keyword} without {CLOSES[keyword]}")
        inner = None
        while len(self.open) > depths[-1] + 1:
            inner = self._popped()
        if keyword.startswith("else"):
            self._divide(row, keyword, self.open[-1])
        else:
            self._close(self._popped(), row)
        if inner is not None:
            raise ExecutionFault("G308", f"O{_shown(inner.label)} {inner.keyword} before O{_shown(label)} {keyword}")

    def _divide(self, row: int, keyword: str, opened: _Open) -> None:
        if opened.has_else:
            raise ExecutionFault("G307", f"O{_shown(opened.label)} {keyword} after else")
        opened.has_else = keyword == "else"
        opened.branches.append(row)

    def _close(self, opened: _Open, row: int) -> None:
        branches = [opened.row, *opened.branches, row]
        if opened.keyword == "if":
            self.flow.next_branch.update(zip(branches, branches[1:], strict=False))
            self.flow.other_end.update(dict.fromkeys(opened.branches, row))
        else:
            self.flow.other_end.update({opened.row: row, row: opened.row})
            self.flow.last_row.update(dict.fromkeys(opened.jumps, row))


_BEGIN: dict[str, Callable[[_Linker, int, str, str], None]] = {
    "sub": _Linker._begin_sub,
    "break": _Linker._jump,
    "continue": _Linker._jump,
    "return": _Linker._return,
}


def link_o_words(words: Mapping[int, OWord]) -> tuple[JumpTargets, tuple[tuple[int, ExecutionFault], ...]]:
    """Match the O words of a program, by row in program order; return their jump targets, and the faults by row."""
    linker = _Linker()
    faults: list[tuple[int, ExecutionFault]] = []
    for row, word in words.items():
        try:
            linker.link(row, word)
        except ExecutionFault as fault:
            faults.append((row, fault))
    for opened in linker.open:
        faults.append((opened.row, ExecutionFault("G308", f"O{_shown(opened.label)} {opened.keyword}")))
    for row, label in linker.macro_loops:
        faults.append((row, ExecutionFault("G308", f"WHILE DO {label}")))
    return linker.flow, tuple(faults)


def _define(rows: dict[str, int], label: str, row: int) -> None:
    if label in rows:
        raise ExecutionFault("G310", f"O{_shown(label)}")
    rows[label] = row


def _shown(label: str) -> str:
    return label if label.isdecimal() else f"<{label}>"
