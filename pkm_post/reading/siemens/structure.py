# SPDX-License-Identifier: LGPL-2.1-or-later
"""Structure: the programs of a file, their labels, and matching starts and ends.

Input: scanned lines and compiled statements. Output: programs by name as ranges of rows, the rows of labels and block
numbers, and partners of loops and branches. An archive has a line %_N_NAME_MPF or %_N_NAME_SPF before each program.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from pkm_post.reading.gcode.blocks import SkippedSwitches, bits_of
from pkm_post.reading.gcode.calls import rows_of_sequence_numbers
from pkm_post.reading.gcode.flow_control import DECIDING, with_their_sources
from pkm_post.reading.gcode.parameters import Name
from pkm_post.reading.siemens.diagnostics import BlockFault, LineDiagnostics
from pkm_post.reading.siemens.flow import Flow
from pkm_post.reading.siemens.items import Assignment, Word
from pkm_post.reading.siemens.scan import STATEMENT, ScannedLines
from pkm_post.reading.siemens.statements import Statement, statement_of

_HEADER = re.compile(r"\s*%\s*(?:_N_)?(\w*?)(?:_(MPF|SPF))?\s*", re.IGNORECASE)
_ENDS = {"ENDIF": "IF", "ENDFOR": "FOR", "ENDWHILE": "WHILE", "ENDLOOP": "LOOP", "UNTIL": "REPEAT"}
_BEGINS = frozenset(_ENDS.values())


@dataclass(frozen=True)
class ProgramRows:
    """A program or subprogram of the file: its name, its first row, and the row after its last."""

    name: str
    first: int
    end: int


@dataclass
class Structure:
    """Data for jumps and calls.

    Attributes:
        statements: by row.
        programs: by name.
        main: the program that runs.
        partners: by row, the matching end or start; for IF its ELSE, and for ELSE its ENDIF.
        labels: rows of a label, in order.
    """

    lines: ScannedLines
    statements: dict[int, Statement] = field(default_factory=dict)
    programs: dict[str, ProgramRows] = field(default_factory=dict)
    main: ProgramRows = field(default_factory=lambda: ProgramRows("", 0, 0))
    partners: dict[int, int] = field(default_factory=dict)
    labels: dict[str, list[int]] = field(default_factory=dict)
    _numbers: dict[str, dict[str, list[int]]] = field(default_factory=dict)
    """Rows by block number, of subblocks N10 and of main blocks :10."""

    @cached_property
    def deciding_names(self) -> frozenset[Name] | None:
        """The variables whose values decide which block follows; None if that may be any, as by ``IF R[R1]>0``."""
        names, assignments = set[Name | None](), list[tuple[Name | None, set[Name | None]]]()
        for statement in self.statements.values():
            flow = statement.flow or Flow("", 0)
            for defined in flow.names:
                names.update(*(each.names for each in defined.size))
                if defined.start is not None:
                    assignments.append((defined.name, {*defined.start.names}))
            if flow.keyword == "FOR":
                names.add(Assignment(flow.names[0].name, flow.names[0].size, flow.values[0], 0).variable())
            names.update(*(each.names for each in flow.values))
            for item in statement.items:
                if isinstance(item, Assignment):
                    used = set[Name | None]().union(item.value.names, *(each.names for each in item.index))
                    assignments.append((item.variable(), used))
                elif isinstance(item, Word):
                    names |= item.value.names if item.name[0] in DECIDING else set()
                else:
                    names.update(*(each.names for each in item.arguments or () if each is not None))
        return with_their_sources(names, assignments)

    def rows_of(self, target: str) -> list[int]:
        """The rows of a label or block number, in order."""
        if target in self.labels:
            return self.labels[target]
        if not re.fullmatch(r"[N:]\d+", target):
            return []
        kind, number = target[0], target[1:]
        if kind not in self._numbers:
            self._numbers[kind] = rows_of_sequence_numbers(self.lines.text, np.arange(1, len(self.lines) + 1), kind)
        return self._numbers[kind].get(number, [])

    def program_of(self, row: int) -> ProgramRows:
        """The program of a row."""
        return next((each for each in self.programs.values() if each.first <= row < each.end), self.main)

    def destination(self, program: ProgramRows, row: int, target: str) -> int:
        """The target row of a jump within a program, by keyword and label [SiemensNC, program jumps].

        Raises:
            BlockFault: there is no such row.
        """
        keyword, _, label = target.partition(" ")
        if keyword == "GOTOS":
            raise BlockFault("G602", "GOTOS, which begins the program again without an end")
        rows = [each for each in self.rows_of(label) if program.first <= each < program.end]
        behind, before = [each for each in rows if each > row], [each for each in rows if each <= row]
        if keyword != "GOTOB" and behind:
            return behind[0]
        if keyword != "GOTOF" and before:
            return before[-1]
        if keyword == "GOTOC":
            return row + 1
        raise BlockFault("G604", target)

    def section(self, program: ProgramRows, row: int, flow: Flow) -> tuple[int, int]:
        """The first row of a section repeated by REPEAT, and the row after it [SiemensNC, section repetition].

        It ends after its second label or ENDLABEL, or else before REPEAT itself; for REPEATB it is one block.

        Raises:
            BlockFault: a label is not in the program.
        """
        rows = [
            next((each for each in self.rows_of(label) if program.first <= each < program.end), -1)
            for label in flow.targets
        ]
        if min(rows) < 0:
            raise BlockFault("G604", f"{flow.keyword.split()[0]} {' '.join(flow.targets)}", flow.column)
        first = rows[0]
        if flow.keyword.startswith("REPEATB"):
            return first, first + 1
        if len(rows) > 1:
            return first, rows[1] + 1
        ends = [each for each in self.rows_of("ENDLABEL") if each >= first]
        return first, ends[0] + 1 if ends and (ends[0] < row or first > row) else row


def structure_of(lines: ScannedLines, block_delete: SkippedSwitches, faults: LineDiagnostics) -> Structure:
    """The structure of a scanned file; malformed statements and unmatched ends are faults."""
    structure = Structure(lines)
    headers: list[tuple[int, str, str]] = []
    for row in np.flatnonzero(lines.kind == STATEMENT).tolist():
        line = lines.line(row)
        if line.lstrip().startswith("%"):
            found = _HEADER.fullmatch(line)
            if found is None:
                faults.add(row, "G206", f"'{line.strip()[:40]}'", 1)
            else:
                headers.append((row, found[1].upper(), (found[2] or "MPF").upper()))
            continue
        try:
            statement = statement_of(line)
        except BlockFault as fault:
            faults.add_fault(row, fault)
            continue
        if not statement.skipped & bits_of(block_delete):
            structure.statements[row] = statement
    _find_programs(structure, headers)
    _find_labels(structure)
    for program in structure.programs.values():
        _find_partners(structure.statements, program, structure.partners, faults)
    return structure


def _find_programs(structure: Structure, headers: list[tuple[int, str, str]]) -> None:
    """The main program is the first one that is an MPF, or else the first of the file."""
    end = len(structure.lines)
    starts = [*headers, (end, "", "")]
    parts = [(headers[0] if headers else (end, "", ""))[0]]
    if not headers or structure.lines.kind[: parts[0]].any():
        structure.main = ProgramRows("", 0, parts[0] if headers else end)
        structure.programs[""] = structure.main
    kinds: dict[str, str] = {}
    for (row, name, kind), (following, _, _) in zip(starts, starts[1:], strict=False):
        structure.programs.setdefault(name, ProgramRows(name, row + 1, following))
        kinds.setdefault(name, kind)
    if "" not in structure.programs:
        name = next((name for name, kind in kinds.items() if kind == "MPF"), next(iter(kinds)))
        structure.main = structure.programs[name]
    for row, statement in structure.statements.items():
        if statement.flow is not None and statement.flow.keyword == "PROC":
            structure.programs.setdefault(statement.flow.targets[0], structure.program_of(row))


def _find_labels(structure: Structure) -> None:
    for row, statement in sorted(structure.statements.items()):
        for label in statement.labels:
            structure.labels.setdefault(label, []).append(row)


def _find_partners(
    statements: Mapping[int, Statement], program: ProgramRows, partners: dict[int, int], faults: LineDiagnostics
) -> None:
    """Match beginnings and ends of one program."""
    open_rows: list[tuple[int, Flow]] = []
    for row in sorted(row for row in statements if program.first <= row < program.end):
        flow = statements[row].flow
        if flow is None:
            continue
        if flow.keyword in _BEGINS:
            open_rows.append((row, flow))
        elif flow.keyword == "ELSE":
            if not open_rows or open_rows[-1][1].keyword != "IF":
                faults.add(row, "G605", "ELSE without IF", flow.column)
            else:
                partners[open_rows.pop()[0]] = row
                open_rows.append((row, flow))
        elif flow.keyword in _ENDS:
            wanted = (_ENDS[flow.keyword], "ELSE") if flow.keyword == "ENDIF" else (_ENDS[flow.keyword],)
            if not open_rows or open_rows[-1][1].keyword not in wanted:
                faults.add(row, "G605", f"{flow.keyword} without {_ENDS[flow.keyword]}", flow.column)
            else:
                begin = open_rows.pop()[0]
                partners[begin], partners[row] = row, begin
    for row, flow in open_rows:
        faults.add(row, "G605", f"{flow.keyword} without an end", flow.column)
