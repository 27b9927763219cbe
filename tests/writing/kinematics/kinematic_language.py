# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small interpreter of the kinematic programs of both PMACs, for many poses at once, without code of the writer.

What it knows is from the manuals: statements, operators and functions of the Turbo PMAC [Turbo PMAC User Manual, p. 248
and 259 to 267] and of the Power PMAC [User's Manual, p. 511 to 519; Software Reference, Command Syntax Summary]. A
variable holds a number, or an array with one for each pose; branches and loops carry a mask. Reading a variable that
nothing has set is an error, and so is any line that is not known.
"""

import operator
import re
from functools import cache

import numpy as np

_TOKEN = re.compile(r"\s*(?:(\$[0-9A-Fa-f]+|\d+(?:\.\d+)?)|([A-Za-z]\w*(?:\[\d+\])?(?:\.\w+)?)|(&&|==|[-+*/()<>=&,]))")
_OPERATORS = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": np.divide}
_OPENING = {"turbo": r"OPEN (FORWARD|INVERSE)", "power": r"open (forward|inverse)"}
_COMMENT = {"turbo": ";", "power": "//"}
DOUBLE, TURBO = 53, 35
"""Bits of a mantissa; a Turbo PMAC has 36 with the sign."""


class Controller:
    """A file as a controller takes it: values set outside of programs, and the two programs."""

    def __init__(self, text, kind, bits=DOUBLE):
        self.kind, self.bits, self.values, self.on_line, self.programs = kind, bits, {}, [], {}
        lines = [line.split(_COMMENT[kind])[0].strip() for line in text.splitlines()]
        collected = self.on_line
        for line in filter(None, lines):
            if opened := re.fullmatch(_OPENING[kind], line):
                collected = self.programs.setdefault(opened[1].lower(), [])
            elif line.lower() == "close":
                collected = self.on_line
            else:
                collected.append(line)
        for line in self.on_line:
            if assigned := re.fullmatch(r"([IQ]\d+|[\w\[\]]+\.\w+)=(-?[\d.]+)", line):
                self.values[assigned[1]] = self.rounded(float(assigned[2]))

    def rounded(self, value):
        if self.bits == DOUBLE:
            return value
        # Veltkamp's splitting: the part of the number that has these bits
        spread = value * (2.0 ** (DOUBLE - self.bits) + 1.0)
        return spread - (spread - value)

    def run(self, program, given):
        """Run a program with further values; returns all values."""
        given = {name: np.atleast_1d(np.asarray(value, float)) for name, value in given.items()}
        count = max(map(len, given.values()))
        statements = _parsed(self.programs[program], self.kind)
        parts = []
        for first in range(0, count, _AT_ONCE):
            rows, here = slice(first, first + _AT_ONCE), min(_AT_ONCE, count - first)
            some = {name: value[rows] if len(value) > 1 else value for name, value in given.items()}
            run = Run(self, self.values | some, here)
            with np.errstate(all="ignore"):
                run.block(statements, np.ones(run.count, dtype=bool))
            parts.append({name: np.broadcast_to(value, run.count) for name, value in run.values.items()})
        names = dict.fromkeys(name for part in parts for name in part)
        unset = [np.full_like(part["Q50"], np.nan) for part in parts]
        return {
            name: np.concatenate([part.get(name, never) for part, never in zip(parts, unset, strict=True)])
            for name in names
        }


_AT_ONCE = 5000
"""Poses per pass: their variables stay in the processor's cache."""


def _parsed(lines, kind):
    """Nested statements: (condition, then, otherwise), (condition, body) of a loop, (target, expression)."""
    words = {
        "turbo": (r"IF \((.*)\)", "ELSE", "ENDIF", r"WHILE \((.*)\)", "ENDWHILE"),
        "power": (r"if \((.*)\) \{", "} else {", "}", r"while \((.*)\) \{", "}"),
    }[kind]
    rest = list(lines)

    def block(*ends):
        found = []
        while rest:
            line = rest.pop(0)
            if line in ends:
                return found, line
            if condition := re.fullmatch(words[0], line):
                then, end = block(words[1], words[2])
                otherwise = block(words[2])[0] if end == words[1] else []
                found.append(("if", condition[1], then, otherwise))
            elif condition := re.fullmatch(words[3], line):
                found.append(("while", condition[1], block(words[4])[0]))
            elif assigned := re.fullmatch(r"([A-Z]\w*(?:\[\d+\]\.\w+)?)=([^=<>]*)", line):
                found.append(("set", assigned[1], assigned[2]))
            elif line not in ("CLEAR", "N100:", "return", "if (D0>0) callsub 100;"):
                raise SyntaxError(line)
        if ends:
            raise SyntaxError(f"missing {ends}")
        return found, None

    return block()[0]


class Run:
    """One run over a number of poses."""

    def __init__(self, controller, values, count):
        self.controller, self.values, self.count = controller, values, count

    def block(self, statements, mask):
        for kind, *parts in statements:
            if kind == "set":
                self.set(parts[0], self.value(parts[1]), mask)
            elif kind == "if":
                holds = self.holds(parts[0])
                for branch, taken in ((parts[1], mask & holds), (parts[2], mask & ~holds)):
                    if taken.any():
                        self.block(branch, taken)
            else:
                running = mask & self.holds(parts[0])
                while running.any():
                    self.block(parts[1], running)
                    running = running & self.holds(parts[0])

    def set(self, name, value, mask):
        if mask.all():
            self.values[name] = value
        else:
            before = self.values.get(name, np.nan)
            self.values[name] = np.where(mask, value, before)

    def holds(self, text):
        result = np.ones(self.count, dtype=bool)
        for part in re.split(r" AND |&&", text):
            if "&" in part:
                left, right = part.split("&")
                bits = np.asarray(self.value(left)).astype(int) & np.asarray(self.value(right)).astype(int)
                result &= bits != 0
                continue
            left, sign, right = re.fullmatch(r"(.*?)(==|[<>=])(.*)", part).groups()
            assert (sign == "==") == (self.controller.kind == "power" and sign not in "<>"), text
            left, right = self.value(left), self.value(right)
            result &= {"<": np.less, ">": np.greater}.get(sign, np.equal)(left, right)
        return result

    def function(self, name, *arguments):
        if self.controller.kind == "turbo":
            assert self.values["I15"] == 0, "the file says whether angles are in degrees"
            if name == "ATAN2":
                return np.degrees(np.arctan2(arguments[0], self.values["Q0"]))
            return {"SIN": sine, "COS": cosine, "SQRT": np.sqrt, "ABS": np.abs}[name](*arguments)
        if name == "atan2d":
            return np.degrees(np.arctan2(*arguments))
        return {"sind": sine, "cosd": cosine, "sqrt": np.sqrt, "abs": np.abs}[name](*arguments)

    def value(self, text):
        return _compiled(text)(self)


@cache
def _compiled(text):
    """A function that gives the value of an expression in a run; each expression is parsed once for all runs."""
    tokens, place, text = [], 0, text.strip()
    while place < len(text):
        token = _TOKEN.match(text, place)
        if token is None:
            raise SyntaxError(text)
        tokens.append(token[0].strip())
        place = token.end()
    found = _Compiler(tokens).sum()
    if tokens:
        raise SyntaxError(text)
    return found


class _Compiler:
    """Makes functions of runs from the tokens of an expression, and takes these away."""

    def __init__(self, tokens):
        self.tokens = tokens

    def sum(self):
        return self.chain("+-", self.product)

    def product(self):
        return self.chain("*/", self.factor)

    def chain(self, signs, operand):
        """Operands from left to right, each result rounded."""
        first, others = operand(), []
        while self.tokens and self.tokens[0] in signs:
            others.append((_OPERATORS[self.tokens.pop(0)], operand()))
        if not others:
            return first

        def evaluate(run):
            found = first(run)
            for combine, other in others:
                found = run.controller.rounded(combine(found, other(run)))
            return found

        return evaluate

    def factor(self):
        token = self.tokens.pop(0)
        if token == "(":
            found = self.sum()
            assert self.tokens.pop(0) == ")"
            return found
        if token[0] == "$":
            return lambda _: float(int(token[1:], 16))
        if token[0].isdigit():
            return lambda run: run.controller.rounded(float(token))
        if not token[0].isalpha():
            raise SyntaxError(token)
        if self.tokens and self.tokens[0] == "(":
            return self.function(token)
        return lambda run: run.values[token]

    def function(self, name):
        self.tokens.pop(0)
        arguments = [self.sum()]
        while self.tokens.pop(0) == ",":
            arguments.append(self.sum())
        return lambda run: run.controller.rounded(run.function(name, *(each(run) for each in arguments)))


def sine(degrees):
    return np.sin(np.radians(degrees))


def cosine(degrees):
    return np.cos(np.radians(degrees))
