# SPDX-License-Identifier: LGPL-2.1-or-later
"""Source language: variables, arithmetic, points and macros of APT part programs, resolved to plain statements.

Input: logical lines. Output: logical lines without them. A statement of a macro keeps its line number in each call.
Angles of functions are in degrees. Only files with assignments or calls are processed this way, line by line.

    A = 10.                    HOLE = MACRO/X,Y,DEPTH=-5
    P = POINT/A,A*2,0          GOTO/X,Y,DEPTH
    GOTO/P                     TERMAC
    GOTO/A+1,SINF(30),0        CALL/HOLE,X=10,Y=A

Source: the words, their parameters with their defaults and the functions are those of APT ([aptos]).
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from pkm_post.reading.cldata.cutcom import PLANES
from pkm_post.reading.cldata.cycle_notation import words_of_cycles
from pkm_post.reading.cldata.diagnostics import StatementDiagnostics
from pkm_post.reading.cldata.feeds import FEED_WORDS
from pkm_post.reading.cldata.interpreter import HANDLERS, IGNORED, UNSUPPORTED
from pkm_post.reading.cldata.logical_lines import JOINT, LogicalLines

MOST_LINES = 1_000_000
"""Most statements of a file, including all calls."""
_DEEPEST_CALL = 20
_LONGEST_EXPRESSION = 500
_VOCABULARY = frozenset({*HANDLERS, *IGNORED, *UNSUPPORTED, *words_of_cycles(), *FEED_WORDS, *PLANES, "LENGTH"})
"""Words that cannot be names."""

_SOURCE = re.compile(r"^[ \t]*(?:(?!N\d+[ \t]*=)[A-Z]\w*[ \t]*=|CALL[ \t]*/)", re.MULTILINE | re.IGNORECASE)
_TEXT = re.compile(
    r"\s*(?:PARTNO|PPRINT|INSERT|LETTER|DISPLY|TPRINT|REMARK|MACHIN|TOOL\s+PATH|OPERATION\s+NAME)(?![\w.-])",
    re.IGNORECASE,
)
_ASSIGNMENT = re.compile(r"\s*([A-Z]\w*)\s*=\s*(.*?)\s*", re.IGNORECASE | re.DOTALL)
_STATEMENT = re.compile(r"([A-Z]\w*)\s*(?:/(.*))?", re.IGNORECASE | re.DOTALL)
_CALL = re.compile(r"\s*CALL\s*/\s*(\w+)\s*(?:,(.*))?", re.IGNORECASE | re.DOTALL)
_TERMAC = re.compile(r"\s*TERMAC\s*", re.IGNORECASE)
_PARAMETER = re.compile(r"\s*([A-Z]\w*)\s*(?:=\s*(.*?))?\s*", re.IGNORECASE | re.DOTALL)
_OPERATION = re.compile(r"[*(]|[\d.][ \t]*[-+/]")
_LEADING_ZEROS = re.compile(r"(?<![\w.])0+(?=\d)")
_FOREIGN = re.compile(r"#|(?<!\w)(?:0[XOB]|\d\w*_)", re.IGNORECASE)
"""Comments and numbers of Python alone, as 0x10 and 1_000, which its parser would take."""
_NAME = re.compile(r"(?<![\w.])[A-Z]\w*", re.IGNORECASE)

_OPERATORS: dict[type[ast.AST], Callable[..., float]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Pow: math.pow, ast.UAdd: operator.pos, ast.USub: operator.neg,
}  # fmt: skip
_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "ABS": abs,
    "SQRT": math.sqrt,
    "SIN": lambda angle: math.sin(math.radians(angle)),
    "COS": lambda angle: math.cos(math.radians(angle)),
    "TAN": lambda angle: math.tan(math.radians(angle)),
    "ATAN": lambda value: math.degrees(math.atan(value)),
}
"""Functions of one number; a final F is optional, as in SINF."""

_Value = float | str | tuple[float, ...]


class _NoValueError(Exception):
    """A text is not an expression of numbers and known names; the message is the reason."""


@dataclass(frozen=True)
class _Macro:
    """Parameters with their defaults, None without one, and the lines of the body."""

    parameters: dict[str, str | None]
    body: range


def expanded(lines: LogicalLines, faults: StatementDiagnostics) -> LogicalLines:
    """Resolve variables, points and macros; lines that are not understood become empty, with a fault."""
    if not _SOURCE.search("\n".join(lines.text)):
        return lines
    expander = _Expander(lines, faults)
    expander.run(range(len(lines.text)))
    return LogicalLines(expander.text, np.array(expander.number, dtype=np.int64))


@dataclass
class _Expander:
    """Walks the lines and their calls.

    Attributes:
        lines: of the file.
        faults: collects the faults.
        values: of the names, in upper case.
        macros: by name, in upper case.
        text: the lines so far.
        number: their line numbers.
        depth: of calls.
    """

    lines: LogicalLines
    faults: StatementDiagnostics
    values: dict[str, _Value] = field(default_factory=dict)
    macros: dict[str, _Macro] = field(default_factory=dict)
    text: list[str] = field(default_factory=list)
    number: list[int] = field(default_factory=list)
    depth: int = 0

    def run(self, indices: range) -> None:
        """Resolve some lines."""
        behind = indices.start
        for index in indices:
            if index < behind:
                continue
            if len(self.text) > MOST_LINES:
                return
            line = self.lines.text[index]
            assignment, call = _ASSIGNMENT.fullmatch(line), _CALL.fullmatch(line)
            if _TEXT.match(line):
                self._write(index, line)
            elif assignment is not None:
                behind = self._assign(index, assignment, indices.stop)
            elif call is not None:
                self._call(index, call)
            else:
                self._write(index, self._resolved(line))

    def _write(self, index: int, text: str) -> None:
        if len(self.text) == MOST_LINES:
            self._report("L403", index, f"more than {MOST_LINES} statements with those of macros")
        if len(self.text) <= MOST_LINES:
            self.text.append(text)
            self.number.append(int(self.lines.number[index]))

    def _report(self, code: str, index: int, found: str) -> None:
        line = self.lines.text[index]
        self.faults.add(code, self.lines.place(index, len(line) - len(line.lstrip())), found)

    def _assign(self, index: int, match: re.Match[str], stop: int) -> int:
        """NAME = expression, POINT/x,y,z or MACRO; a label before a statement; return the next line to read."""
        name, right = match[1].upper(), match[2]
        statement = _STATEMENT.fullmatch(right)
        word = statement[1].upper() if statement else ""
        if word == "MACRO" and statement:
            return self._define(index, name, statement[2] or "", stop)
        if word == "POINT" and statement:
            self._set(index, name, lambda: tuple(map(self._number, _items(statement[2] or ""))))
        elif word and word not in self.values:
            self._write(index, self._resolved(self.lines.text[index]))
        else:
            self._set(index, name, lambda: self._number(right))
        return index + 1

    def _set(self, index: int, name: str, value: Callable[[], _Value]) -> None:
        """Give a name its value."""
        self._write(index, "")
        if name in _VOCABULARY:
            self._report("L402", index, f"{name}, a word of CL data, as a name")
            return
        try:
            self.values[name] = value()
        except _NoValueError as fault:
            self._report("L402", index, f"{name} = {fault}")

    def _define(self, index: int, name: str, parameters: str, stop: int) -> int:
        """NAME = MACRO/parameters up to TERMAC; return the line after it."""
        self._write(index, "")
        end = next((at for at in range(index + 1, stop) if _TERMAC.fullmatch(self.lines.text[at])), None)
        pairs = [_PARAMETER.fullmatch(item) for item in _items(parameters)]
        if end is None or not all(pairs):
            self._report("L402", index, f"{name} = MACRO, expected names of parameters, and TERMAC at its end")
            return stop if end is None else end + 1
        self.macros[name] = _Macro({pair[1].upper(): pair[2] for pair in pairs if pair}, range(index + 1, end))
        return end + 1

    def _call(self, index: int, match: re.Match[str]) -> None:
        """CALL/NAME,parameter=value,...: the body with these values, which the parameters lose at its end."""
        self._write(index, "")
        macro = self.macros.get(match[1].upper())
        pairs = [_PARAMETER.fullmatch(item) for item in _items(match[2] or "")]
        given = {pair[1].upper(): pair[2] for pair in pairs if pair}
        if macro is None or self.depth == _DEEPEST_CALL:
            why = "which is not defined before" if macro is None else f"more than {_DEEPEST_CALL} calls within calls"
            self._report("L402", index, f"CALL/{match[1]}, {why}")
            return
        values = {**macro.parameters, **given}
        wrong = sorted({*given} - {*macro.parameters} | {name for name, value in values.items() if value is None})
        if wrong or not all(pairs):
            self._report("L402", index, f"CALL/{match[1]}, parameters {', '.join(wrong)} unknown or without a value")
            return
        before = self.values
        try:
            self.values = {**before, **{name: self._value(text or "") for name, text in values.items()}}
        except _NoValueError as fault:
            self._report("L402", index, f"CALL/{match[1]}, {fault}")
            return
        self.depth += 1
        self.run(macro.body)
        self.depth -= 1
        kept = {name: value for name, value in self.values.items() if name not in values}
        self.values = {**kept, **{name: before[name] for name in values if name in before}}

    def _resolved(self, line: str) -> str:
        """A statement with numbers in place of names and expressions."""
        head, slash, items = line.partition("/")
        if not slash or not self._has_expression(items):
            return line
        return f"{head}/{','.join(map(self._item, _items(items)))}"

    def _has_expression(self, text: str) -> bool:
        return _OPERATION.search(text) is not None or any(name.upper() in self.values for name in _NAME.findall(text))

    def _item(self, item: str) -> str:
        """An item with numbers in place of names and expressions; other items unchanged."""
        if not self._has_expression(item):
            return item
        try:
            return _written(self._value(item))
        except _NoValueError:  # a statement in parentheses, or a fault that the grammar reports
            return _NAME.sub(lambda name: _written(self.values.get(name[0].upper(), name[0])), item)

    def _value(self, text: str) -> _Value:
        """The number of an expression, the point of a name, or a word unchanged."""
        name = text.strip().upper()
        value = self.values.get(name)
        if value is not None:
            return value
        return name if re.fullmatch(r"[A-Z]\w*", name) else self._number(text)

    def _number(self, text: str) -> float:
        """The number of an expression.

        Raises:
            _NoValueError: the expression has none.
        """
        shown = text.strip()[:40]
        if len(text) > _LONGEST_EXPRESSION:
            raise _NoValueError(f"{shown}..., too long")
        if _FOREIGN.search(text):
            raise _NoValueError(f"{shown}, no expression of numbers and names")
        try:
            value = self._evaluated(
                ast.parse(_LEADING_ZEROS.sub("", text.replace(JOINT, " ").strip()), mode="eval").body
            )
        except (SyntaxError, RecursionError, MemoryError):
            raise _NoValueError(f"{shown}, no expression of numbers and names") from None
        except (ArithmeticError, ValueError):
            raise _NoValueError(f"{shown}, which has no value") from None
        if not math.isfinite(value):
            raise _NoValueError(f"{shown}, which is not finite")
        return value

    def _evaluated(self, node: ast.expr) -> float:
        match node:
            case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
                return float(number)
            case ast.Name(id=name):
                value = self.values.get(name.upper())
                if isinstance(value, float):
                    return value
                raise _NoValueError(f"{name}, which has no number before")
            case ast.UnaryOp(op=sign, operand=operand) if type(sign) in _OPERATORS:
                return _OPERATORS[type(sign)](self._evaluated(operand))
            case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _OPERATORS:
                return _OPERATORS[type(sign)](self._evaluated(left), self._evaluated(right))
            case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]):
                function = _FUNCTIONS.get(name.upper()) or _FUNCTIONS.get(name.upper().removesuffix("F"))
                if function is not None:
                    return function(self._evaluated(argument))
                raise _NoValueError(f"{name}(...), expected {', '.join(_FUNCTIONS)}")
        raise _NoValueError("an expression, expected numbers, names, + - * / ** and functions")


def _written(value: _Value) -> str:
    """A value as one or several items."""
    if isinstance(value, tuple):
        return ",".join(map(_written, value))
    return f"{value:.17g}" if isinstance(value, float) else value


def _items(text: str) -> list[str]:
    """The items of a text, at commas outside parentheses; none of an empty text."""
    items, depth = [""], 0
    for part in re.split(r"([(),])", text):
        depth += (part == "(") - (part == ")")
        if part == "," and depth <= 0:
            items.append("")
        else:
            items[-1] += part
    return items if text.strip() else []
