# SPDX-License-Identifier: LGPL-2.1-or-later
"""Variables, points and macros of APT: the same motion as with the numbers written out, and what is refused."""

import math
import random

import pytest

from pkm_post.model.diagnostics import errors
from pkm_post.reading.cldata import ReadOptions, read
from pkm_post.reading.cldata import source_language as language

HEAD = "UNITS/MM\nLOADTL/1,LENGTH,100\nFEDRAT/600,MMPM\nRAPID\nGOTO/0,0,50\n"


def program(text):
    found, diagnostics = read(f"{HEAD}{text}FINI\n", "part.apt", ReadOptions(dialect="apt"))
    assert found is not None, "\n".join(map(str, diagnostics))
    return found


def faults(text):
    found, diagnostics = read(f"{HEAD}{text}GOTO/1,2,3\nFINI\n", "part.apt", ReadOptions(dialect="apt"))
    assert found is None
    return [(fault.code, fault.place.line) for fault in errors(diagnostics)]


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("A=10\nGOTO/A,-A,a/4\n", "GOTO/10,-10,2.5\n"),
        ("A=2\nB = A $\n +1\nGOTO/B,A $ $$ two lines\n -1,0\n", "GOTO/3,1,0\n"),
        ("A = 2.\nB = A**3 + 1\nGOTO/(A+B)*2,B-A,0\n", "GOTO/22,7,0\n"),
        ("GOTO/5*SINF(30),5*COS(60),SQRTF(16)\n A=1\n", "GOTO/2.5,2.5,4\n"),
        ("P1=POINT/1,2,3\nGOTO/P1\nGOTO/P1,0,0,1\n", "GOTO/1,2,3\nGOTO/1,2,3,0,0,1\n"),
        ("A=4\nGOTO/0,-A,0\nCIRCLE/0,0,0,$\n0,0,1,A\nGOTO/A,0,0\nCIRCLE/0,0,0,0,0,1,A\nGOTO/0,A,0\n",
         "GOTO/0,-4,0\nCIRCLE/0,0,0,$\n0,0,1,4\nGOTO/4,0,0\nCIRCLE/0,0,0,0,0,1,4\nGOTO/0,4,0\n"),
        ("F=100\nFEDRAT/F*2,MMPM\nGOTO/1,0,0\nF=50\nFEDRAT/MMPM,F\nGOTO/2,0,0\n",
         "FEDRAT/200,MMPM\nGOTO/1,0,0\nFEDRAT/MMPM,50\nGOTO/2,0,0\n"),
        ("N10=GOTO/1,2,3\nA=1\nLAST=GOTO/A,A,A\nPPRINT A=B*C\n", "GOTO/1,2,3\nGOTO/1,1,1\n"),
        ("A=4\nGOTO/A,0,0\nINDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,0,A),ON,(LINE/0,0,0,0,A,0)\n",
         "GOTO/4,0,0\nCIRCLE/0,0,0,0,0,1\nGOTO/0,4,0\n"),
        ("A=1\nPPRINT/A\nREMARK A*2\n", ""),
        ("A=05\nGOTO/A-2,10-2,10/4\nGOTO/1.E-3,+5 - 2,007*1\n", "GOTO/3,8,2.5\nGOTO/0.001,3,7\n"),
        ("A=1\nGOTO/1.5-.5-1,2/4/5,-1-1\nGOTO/-1.E+1,1E2-1,.5\n", "GOTO/0,.1,-2\nGOTO/-10,99,.5\n"),
    ],
)  # fmt: skip
def test_names_stand_for_their_numbers(text, plain):
    named, written = (program(f"{each}GOTO/9,0,9\n") for each in (text, plain))
    assert named.position == pytest.approx(written.position, abs=1e-12)
    assert named.kind.tolist() == written.kind.tolist()
    assert named.feed == pytest.approx(written.feed, nan_ok=True)


HOLE = "HOLE=MACRO/X,Y,DEPTH=-5,WAY=RAPID\nRAPID\nGOTO/X,Y,2\nGOTO/X,Y,DEPTH\nLAST=X\nTERMAC\n"


def test_a_macro_is_its_body_with_its_parameters():
    found = program(f"X=7\n{HOLE}CALL/HOLE,X=10,Y=X*2\nCALL/HOLE,Y=1,X=20,DEPTH=-1\nGOTO/X,LAST,0\n")
    assert found.position[1:].tolist() == [[10, 14, 2], [10, 14, -5], [20, 1, 2], [20, 1, -1], [7, 20, 0]]
    assert found.line[1:].tolist() == [9, 10, 9, 10, 15]


def test_macros_call_macros():
    row = "ROW=MACRO/Y\nCALL/HOLE,X=0,Y=Y\nCALL/HOLE,X=1,Y=Y\nTERMAC\n"
    found = program(f"{HOLE}{row}CALL/ROW,Y=3\nCALL/ROW,Y=4\n")
    assert found.position[1::2].tolist() == [[0, 3, 2], [1, 3, 2], [0, 4, 2], [1, 4, 2]]


def test_a_word_is_a_parameter_as_well():
    turn = "TURN=MACRO/SENSE\nSPINDL/500,SENSE\nTERMAC\nCALL/TURN,SENSE=CCLW\n"
    assert [event.value for event in program(turn).events][-1] == -500


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("A=B*2\n", [("L402", 6)]),
        ("A=1/0\n", [("L402", 6)]),
        ("A=10**400\n", [("L402", 6)]),
        ("A=(-1)**0.5\n", [("L402", 6)]),
        ("A=1+\n", [("L402", 6)]),
        ("A=LOGF(2)\n", [("L402", 6)]),
        ("A=1 if 2 else 3\n", [("L402", 6)]),
        ("A=__import__('os')\n", [("L402", 6)]),
        ("A=1_000\n", [("L402", 6)]),
        ("A=0x10\n", [("L402", 6)]),
        ("A=5 # 6\n", [("L402", 6)]),
        ("CLEAR=5\n", [("L402", 6)]),
        ("LENGTH=5\nLOADTL/2,LENGTH,120\n", [("L402", 6)]),  # was LOADTL/2,5,120: no length
        ("XYPLAN=1\nCUTCOM/LEFT,XYPLAN\n", [("L402", 6)]),  # was a register
        ("P=POINT/1,B*2,3\n", [("L402", 6)]),
        ("M=MACRO/X\nGOTO/X,0,0\n", [("L402", 6)]),
        ("M=MACRO/1\nTERMAC\n", [("L402", 6)]),
        ("CALL/M,X=1\n", [("L402", 6)]),
        ("M=MACRO/X\nGOTO/X,0,0\nTERMAC\nCALL/M\n", [("L402", 9)]),
        ("M=MACRO/X\nGOTO/X,0,0\nTERMAC\nCALL/M,X=1/0\n", [("L402", 9)]),
        ("M=MACRO/X\nGOTO/X,0,0\nTERMAC\nCALL/M,X=B+1\n", [("L402", 9)]),
        ("M=MACRO/X\nGOTO/X,0,0\nTERMAC\nCALL/M,X=1,Y=2\n", [("L402", 9)]),
        ("M=MACRO/X\nCALL/M,X=X\nTERMAC\nCALL/M,X=1\n", [("L402", 7)]),
        ("A=1\nTERMAC\n", [("L401", 7)]),
        ("MACRO\n", [("L401", 6)]),
        ("A=1\nGOTO/A,B,0\n", [("L402", 7)]),
    ],
)
def test_what_has_no_value_is_refused_where_it_stands(text, expected):
    assert faults(text) == expected


def test_calls_without_end_are_bounded(monkeypatch):
    monkeypatch.setattr(language, "MOST_LINES", 50)
    macros = "A=MACRO\nGOTO/1,2,3\nGOTO/1,2,4\nTERMAC\nB=MACRO\n" + "CALL/A\n" * 30 + "TERMAC\nCALL/B\n"
    assert faults(macros)[0][0] == "L403"
    calls = "".join(f"M{each}=MACRO\n" + f"CALL/M{each - 1}\n" * 10 + "TERMAC\n" for each in range(1, 18))
    assert faults(f"M0=MACRO\nTERMAC\n{calls}CALL/M17\n")[0][0] == "L403"  # no line is read of 10^17 calls


def test_a_file_without_names_keeps_its_lines():
    from pkm_post.reading.cldata.diagnostics import StatementDiagnostics
    from pkm_post.reading.cldata.logical_lines import logical_lines

    lines = logical_lines(f"{HEAD}N5=GOTO/1,2,3\nPPRINT A=5\n")
    assert language.expanded(lines, StatementDiagnostics("part.apt")) is lines


FUNCTIONS = {"SINF": lambda a: math.sin(math.radians(a)), "COSF": lambda a: math.cos(math.radians(a)), "ABSF": abs}


class Expressions:
    """Random expressions as text, and their values by a recursion of their own."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.names = {f"V{index}": round(self.random.uniform(-9, 9), 3) for index in range(4)}

    def __call__(self, depth):
        kind = self.random.randrange(6) if depth else self.random.randrange(2)
        if kind == 0:
            number = round(self.random.uniform(0, 99), self.random.randrange(4))
            return repr(number), number
        if kind == 1:
            return self.random.choice(list(self.names.items()))
        text, value = self(depth - 1)
        if kind == 2:
            return f"(-({text}))", -value
        if kind == 3:
            name = self.random.choice(list(FUNCTIONS))
            return f"{name}({text})", FUNCTIONS[name](value)
        other, second = self(depth - 1)
        sign = self.random.choice("+-*")
        return f"({text} {sign} {other})", {"+": value + second, "-": value - second, "*": value * second}[sign]


def test_random_expressions_agree_with_a_second_evaluation():
    for seed in range(40):
        expressions = Expressions(seed)
        pairs = [pair for pair in (expressions(4) for _ in range(50)) if abs(pair[1]) < 1e6]
        text = "".join(f"{name}={value!r}\n" for name, value in expressions.names.items())
        found = program(text + "".join(f"GOTO/{one},0,0\n" for one, _ in pairs))
        assert found.position[1:, 0] == pytest.approx([value for _, value in pairs], abs=1e-9)
