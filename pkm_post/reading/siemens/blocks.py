# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blocks: one block with its values computed, and the notes of a program for the report.

Input: compiled items and the variables of the running program. Output: codes, words, names and calls.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from pkm_post.reading.gcode.adapt import first_lines
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.expressions import Expression, computed_index
from pkm_post.reading.siemens.items import Assignment, Item, Name, Word
from pkm_post.reading.siemens.variables import Value, Variables

_CODE_TOLERANCE = 1e-3


@dataclass(frozen=True)
class Call:
    """A name, with computed arguments if it has brackets."""

    name: str
    arguments: tuple[Value | None, ...] | None
    column: int

    def number(self, index: int, default: float | None = None) -> float:
        """An argument that is a number, by its index from 0; without a default it is required.

        Raises:
            BlockFault: it is a text, or missing.
        """
        value = self.arguments[index] if self.arguments is not None and index < len(self.arguments) else None
        if value is None and default is None:
            raise BlockFault("G405", f"argument {index + 1} of {self.name}", self.column)
        if isinstance(value, str):
            raise BlockFault("G606", f'"{value}" as argument {index + 1} of {self.name}', self.column)
        return float(default if value is None and default is not None else value or 0.0)

    def gives(self, index: int) -> bool:
        """Whether an argument is given."""
        return self.arguments is not None and index < len(self.arguments) and self.arguments[index] is not None


@dataclass
class Block:
    """One computed block.

    Attributes:
        row: in the file, from 0.
        g: G codes.
        m: M codes.
        words: values of all other words.
        modes: by word, AC or IC, and directions to an angle.
        names: names and calls.
        columns: column by word.
    """

    row: int
    g: list[int] = field(default_factory=list)
    m: list[int] = field(default_factory=list)
    words: dict[str, Value] = field(default_factory=dict)
    modes: dict[str, str] = field(default_factory=dict)
    names: list[Call] = field(default_factory=list)
    columns: dict[str, int] = field(default_factory=dict)

    def number(self, name: str) -> float:
        """The value of a word that is a number.

        Raises:
            BlockFault: it is a text.
        """
        value = self.words[name]
        if isinstance(value, str):
            raise BlockFault("G606", f'{name}="{value}"', self.columns[name])
        return value


def block_of(row: int, items: Sequence[Item], variables: Variables) -> Block:
    """Compute a block; its assignments are executed from left to right.

    Raises:
        BlockFault: a value cannot be computed, or a word occurs twice.
    """
    block = Block(row)
    for item in items:
        if isinstance(item, Word):
            _add_word(block, item, variables)
        elif isinstance(item, Name):
            arguments = item.arguments
            values = None if arguments is None else tuple(computed(each, variables) for each in arguments)
            block.names.append(Call(item.name, values, item.column))
        else:
            assign(item, variables)
    return block


def computed(value: Expression | None, variables: Variables) -> Value | None:
    """The value of an optional expression."""
    return None if value is None else value.value(variables)


def assign(item: Assignment, variables: Variables) -> None:
    """Give a variable its new value.

    Raises:
        BlockFault: the value cannot be computed, or the variable does not exist.
    """
    index = computed_index(item.index, variables, item.column)
    try:
        variables.assign(item.name, index, item.value.value(variables))
    except BlockFault as fault:
        raise fault.at(item.column) from None


def _add_word(block: Block, word: Word, variables: Variables) -> None:
    name, value = word.name, word.value.value(variables)
    if name in ("M1", "S1"):  # M1=3 and S1=500 are for spindle 1, the only one here
        name = name[0]
    if name in ("G", "M"):
        code = value if isinstance(value, str) else round(value)
        if isinstance(value, str) or isinstance(code, str) or abs(value - code) > _CODE_TOLERANCE or code < 0:
            raise BlockFault("G105", f"{name}{value}", word.column)
        (block.g if name == "G" else block.m).append(code)
        block.columns.setdefault(f"{name}{code}", word.column)
        return
    if name in block.words:
        raise BlockFault("G202", name, word.column)
    block.words[name] = value
    block.columns[name] = word.column
    if word.mode:
        block.modes[name] = word.mode


class Notes:
    """Accepted items without effect, by name, with the first lines."""

    def __init__(self) -> None:
        self._rows: dict[str, dict[int, None]] = {}

    def add(self, text: str, row: int) -> None:
        """Note something in a row."""
        self._rows.setdefault(text, {})[row] = None

    def lines(self) -> tuple[str, ...]:
        """One line of text for each."""
        return tuple(f"{text} ({first_lines([row + 1 for row in rows])})" for text, rows in self._rows.items())
