# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults of execution: each with its code, its line and, where there is one, its column."""

import random

import pytest
from by_block import scan_by_block
from executed import execute
from series import cases

from pkm_post.model import errors
from pkm_post.model.rules import RULES
from pkm_post.reading.gcode.o_words import link_o_words
from pkm_post.reading.gcode.options import ExecutionLimits, ReadOptions
from pkm_post.reading.gcode.read import read
from pkm_post.reading.gcode.statements import OWord

BLOCKS = """#1=[#1+1]|##1=2|X#1|X#<a>|#<a>=1|M98 P5 L2|M2|G1 X1|/Y2|X[1/#1]|G#1|o#1 call|o7 call [#1+1]|o5 call
#31=[#31-1]|o{0} break|o{0} continue|o7 return [#1]|o7 endsub|M99|o{0} endif|o{0} if [1]""".replace("\n", "|").split(
    "|"
)
FRAMES = [
    "o{0} if [#1 lt 3]\n{1}o{0} elseif [#31 gt 1]\n{1}o{0} else\n{1}o{0} endif\n",
    "o{0} while [#1 lt 5]\n#1=[#1+1]\n{1}o{0} endwhile\n",
    "o{0} do\n{1}o{0} while [#31 gt 0]\n",
    "o{0} repeat [3]\n{1}o{0} endrepeat\n",
]
OUTSIDE = "M99 outside of a subprogram called by M98"
FAULTS = [
    ("G0 X#<depth>", "G301", 1, 5, "#<depth>"),
    ("G0 X#<_depth>", "G301", 1, 5, "#<_depth>"),
    ("o1 sub\nX#<a>\no1 endsub\n#<a>=1\no1 call", "G301", 2, 2, "#<a>"),
    ("G0 X1\nY#0", "G302", 2, 2, "#0"),
    ("X#5602", "G302", 1, 2, "#5602"),
    ("X#1.5", "G302", 1, 2, "#1.5"),
    ("#[0-1]=3", "G302", 1, 2, "#-1"),
    ("#5602=3", "G302", 1, 1, "#5602"),
    ("X#5420", "G303", 1, 2, "#5420: the current position"),
    ("#5221=10", "G303", 1, 1, "#5221: a work offset"),
    ("#1=5400\nX##1", "G303", 2, 3, "#5400: the tool in the spindle"),
    ("X#<_x>", "G303", 1, 2, "#<_x>"),
    ("#<_feed>=3", "G303", 1, 1, "#<_feed>"),
    ("#<_value>=3", "G303", 1, 1, "#<_value>: set by calls alone"),
    ("X[1/0]", "G304", 1, 4, "1 / 0"),
    ("X[5 mod [1-1]]", "G304", 1, 5, "5 mod 0"),
    ("X[0**-1]", "G304", 1, 4, "0 ** -1"),
    ("#[1/0]=3", "G304", 1, 4, "1 / 0"),
    ("Xsqrt[0-4]", "G305", 1, 2, "sqrt of -4"),
    ("Xln[0]", "G305", 1, 2, "ln of 0"),
    ("Xacos[2]", "G305", 1, 2, "acos of 2"),
    ("Xasin[-2]", "G305", 1, 2, "asin of -2"),
    ("Xexp[1000]", "G305", 1, 2, "exp of 1000"),
    ("X[-2**0.5]", "G305", 1, 5, "-2 ** 0.5"),
    ("X[10**308*10]", "G305", 1, 10, "* of 1e+308, 10"),
    ("X[10**400]", "G305", 1, 5, "** of 10, 400"),
    ("G[1+0.04] X1", "G306", 1, 3, "G1.04"),
    ("M[2+0.3]", "G306", 1, 3, "M2.3"),
    ("G[1-2]", "G306", 1, 3, "G-1"),
    ("o1 endif", "G307", 1, 0, "O1 endif without if"),
    ("o1 else", "G307", 1, 0, "O1 else without if"),
    ("o1 elseif [1]", "G307", 1, 0, "O1 elseif without if"),
    ("o<a> endwhile", "G307", 1, 0, "O<a> endwhile without while"),
    ("o1 endrepeat", "G307", 1, 0, "O1 endrepeat without repeat"),
    ("o1 endsub", "G307", 1, 0, "O1 endsub without sub"),
    ("o1 if [1]\no2 endif\no1 endif", "G307", 2, 0, "O2 endif without if"),
    ("o1 if [1]\no1 else\no1 else\no1 endif", "G307", 3, 0, "O1 else after else"),
    ("o1 break", "G307", 1, 0, "O1 break, outside of a loop of this label"),
    ("o1 if [1]\no1 continue\no1 endif", "G307", 2, 0, "O1 continue, outside of a loop of this label"),
    ("o1 if [1]", "G308", 1, 0, "O1 if"),
    ("X1\no1 while [0]", "G308", 2, 0, "O1 while"),
    ("o1 do", "G308", 1, 0, "O1 do"),
    ("o1 repeat [2]", "G308", 1, 0, "O1 repeat"),
    ("o1 sub", "G308", 1, 0, "O1 sub"),
    ("o1 while [0]\no2 if [1]\no1 endwhile", "G308", 3, 0, "O2 if before O1 endwhile"),
    ("M98 P7\nM2\nO7\nX1", "G308", 3, 0, "subprogram without M99"),
    ("o5 call", "G309", 1, 0, "O5 call"),
    ("#1=6\no#1 call", "G309", 2, 0, "O6 call"),
    ("o<probe> call [1]", "G309", 1, 0, "O<probe> call"),
    ("X1\nM98 P7", "G309", 2, 0, "M98 P7"),
    ("o1 sub\no1 endsub\nM98 P1", "G309", 3, 0, "M98 P1"),
    ("o1 sub\no1 endsub\no1 sub\no1 endsub", "G310", 3, 0, "O1"),
    ("O7\nX1\nO7", "G310", 3, 0, "O7"),
    ("o1 while [0]\no1 if [1]\no1 endif\no1 endwhile", "G310", 2, 0, "O1 if within another O1"),
    ("o1.5 call", "G311", 1, 2, "O1.5"),
    ("o[1/2] call", "G311", 1, 3, "O0.5"),
    ("o#1 if [1]\nX1", "G311", 1, 3, "the label of if is computed"),
    ("X1\no<a>", "G311", 2, 0, "O<a> without a keyword such as call or sub, behind the first block"),
    ("o1 sub\no2 sub\no2 endsub\no1 endsub", "G312", 2, 0, "O2 sub within another sub"),
    ("o1 return", "G312", 1, 0, "O1 return outside of a sub"),
    ("o1 if [1]\nO7\no1 endif", "G312", 2, 0, "O7 within O1 if"),
    ("X1\nM99", "G312", 2, 0, f"{OUTSIDE}, which ends a program with --flavour fanuc alone"),
    ("o1 sub\nM99\no1 endsub\no1 call", "G312", 2, 0, OUTSIDE),
    ("M98 P7\nM2\nO7\nM99 P3", "G312", 4, 0, "M99 P"),
    ("M98 P7\nM2\nO7\nM99 L0", "G312", 4, 0, "M99 L, which changes the number of passes on some controls"),
    ("o1 sub\no1 endsub\no1 call" + " [1]" * 31, "G315", 3, 130, "31 arguments"),
    ("M98", "G316", 1, 0, "M98"),
    ("M98 P1.5 L2", "G316", 1, 0, "M98 P1.5 L2"),
    ("M98 P7 L[0-1]\nO7\nM99", "G316", 1, 0, "M98 P7 L-1"),
    ("M98 M99 P7\nO7", "G316", 1, 0, "M98 M99"),
    ("M98 M30 P7\nO7", "G316", 1, 0, "M98 M30"),
]
ENDLESS = [
    "o1 while [1]\no1 endwhile",
    "o1 while [1]\nG1 X1\no1 endwhile",
    "o1 do\n#1=[#1+1]\nX#1\no1 while [1]",
    "o1 repeat [1000000000]\no1 endrepeat",
    "o1 while [1]\no1 continue\no1 endwhile",
    "o1 while [1]\nM98 P7\no1 endwhile\nM2\nO7\nM99",
    "M98 P7 L1000000000\nM2\nO7\nM99",
    "o1 sub\no1 endsub\no2 while [1]\no1 call [1] [2]\no2 endwhile",
    "o1 while [1]\no2 if [0]\no2 elseif [0]\no2 elseif [0]\no2 endif\no1 endwhile",
]

AGAIN = "it jumps back again and again, and no variable that decides this has changed"
UNCHANGED = [
    ("o1 while [1]\no1 endwhile", 2),
    ("o1 do\n#1=[1-#1]\nX#1\no1 while [1]", 4),
    ("#<_n>=0\no1 while [1]\n#<_n>=0\no2 repeat [3]\n#<_n>=[#<_n>+1]\no2 endrepeat\no1 endwhile", 6),
    ("o1 while [1]\nM98 P7\no1 endwhile\nM2\nO7\nM99", 3),
    ("o1 sub\nX#1\no1 endsub\no2 while [1]\no1 call [1] [2]\no2 endwhile", 6),
    ("#1=0\n#2=0\no1 while [#1 lt 10]\n#2=[#2+1]\nX#2\no1 endwhile", 6),
    ("o1 sub\n#2=0\no2 while [#1 lt 10]\n#2=[#2+1]\no2 endwhile\no1 endsub\no1 call [1]", 5),
]
UNCHANGED_IN_MACROS = [
    ("#1=0\n#2=0\nWHILE[#1 LT 10] DO1\nG1 X#2\n#2=#2+1\nEND1\nM30\n", 7),
    ("G65 P9 A1.\nM30\nO9\n#2=0\nN1 #2=#2+#1\nIF[#1 LT 10] GOTO 1\nM99\n", 7),
    ("#2=0\nN1 #2=#2+1\nG1 X#2\nM99 P1\n", 5),
]
COUNTED = [
    "o1 repeat [2000]\nX1\no1 endrepeat\n",
    "o1 while [#5000 lt 2000]\n#5000=[#5000+1]\nX1\no1 endwhile\n",
    "#<_n>=0\no1 while [#<_n> lt 2000]\n#<_n>=[#<_n>+1]\nX1\no1 endwhile\n",
    "#<a>=0\no1 while [#<a> lt 2000]\n#<a>=[#<a>+1]\nX1\no1 endwhile\n",
    "M98 P7 L2000\nM2\nO7\nX1\nM99\n",
    "#1=0\n#2=0\no1 while [#1 lt 2000]\n#3=[#2+1]\n#2=#3\n#1=#2\nX1\no1 endwhile\n",
    "#2=0\no1 while [#[1+1] lt 2000]\n#2=[#2+1]\nX1\no1 endwhile\n",
    "#2=0\n#1=0\n#3=1\no1 while [#1 lt 2000]\n#2=[#2+1]\n#[#3]=#2\nX1\no1 endwhile\n",
    "#2=0\no1 do\n#2=[#2+1]\nX1\no2 if [#2 ge 2000]\no1 break\no2 endif\no1 while [1]\n",
    "o1 sub\no1 endsub [#1+1]\n#<n>=0\no2 while [#<n> lt 2000]\nX1\no1 call [#<n>]\n#<n>=#<_value>\no2 endwhile\n",
]
COUNTED_BY_MACROS = [
    "#100=0\nN1 G1 X#100\n#100=#100+1\nIF [#100 LT 700] GOTO 1\nM30\n",
    "#500=0\nN1 G1 X#500\n#500=#500+1\nIF [#500 LT 700] GOTO 1\nM30\n",
    "G65 P9 A1.\nM30\nO9\nN1 G1 X#1\n#1=#1+1\nIF [#1 LT 700] GOTO 1\nM99\n",
    "G65 P9 L700 A1.\nM30\nO9\nG1 X#1\n#1=#1+1\nM99\n",
    "#1=0\nN1 #1=#1+1\nG1 X#1 M[30*[#1 GE 700]]\nGOTO 1\n",
    "#100=0\nG66 P9\nN1 G1 X#2\nN2 X1.\nIF[#100 LT 699] GOTO 2\nG67\nM30\nO9\n#100=#100+1\nM99\n",
]


def faults_of(text, **limits):
    blocks, faults = scan_by_block(text, "part.ngc")
    assert faults == ()
    plain, faults = execute(blocks, ExecutionLimits(**limits))
    assert plain is None
    return [(fault.code, fault.place.line, fault.place.column, fault.found) for fault in faults]


@pytest.mark.parametrize(("text", "code", "line", "column", "found"), FAULTS)
def test_fault(text, code, line, column, found):
    assert faults_of(text) == [(code, line, column, found)]


def test_every_fault_of_execution_is_shown_here():
    by_limit, elsewhere = {"G313", "G314"}, {"G317", "G318", "G319", "G320"}
    assert {fault[1] for fault in FAULTS} | by_limit | elsewhere == {code for code in RULES if code.startswith("G3")}


def test_faults_of_structure_are_reported_at_once():
    faults = faults_of("o1 endif\no2 while [1]\no1.5 call\no3 break\n")
    assert [fault[:2] for fault in faults] == [("G307", 1), ("G308", 2), ("G311", 3), ("G307", 4)]


@pytest.mark.parametrize("text", ENDLESS)
def test_endless_programs_end(text):
    (fault,) = faults_of(text, blocks=100)
    assert (fault[0], fault[3]) == ("G313", "more than 100 executed blocks")


@pytest.mark.parametrize(("text", "line"), UNCHANGED)
def test_loops_that_change_nothing_are_found_without_the_limit(text, line):
    assert faults_of(text) == [("G313", line, 0, AGAIN)]


@pytest.mark.parametrize(("text", "line"), UNCHANGED_IN_MACROS)
def test_loops_of_macros_that_change_nothing_are_found_without_the_limit(text, line):
    _, faults = read("G90 G21 G94 F60 G0 X0 Y0 Z0\n" + text, "part.nc", ReadOptions(flavour="fanuc"))
    assert [(fault.code, fault.place.line, fault.found) for fault in errors(faults)] == [("G313", line, AGAIN)]


@pytest.mark.parametrize("text", COUNTED)
def test_loops_that_count_in_any_memory_end(text):
    plain, faults = execute(scan_by_block(text, "part.ngc")[0])
    assert faults == ()
    assert (plain.word("X") == 1).sum() == 2000


@pytest.mark.parametrize("text", COUNTED_BY_MACROS)
def test_loops_that_count_in_variables_of_macros_end(text):
    program, faults = read("G90 G21 G94 F60 G0 Y0 Z0\n" + text, "part.nc", ReadOptions(flavour="fanuc"))
    assert errors(faults) == ()
    assert len(program) in (699, 700)


@pytest.mark.slow
def test_loops_that_count_by_the_position_end():
    text = "G90 G21 G94 F60\nG1 X0 Y0 Z0\nN1 G91 X1.\nIF [#5001 LT 300] GOTO 1\nM30\n"
    program, faults = read(text, "part.nc", ReadOptions(flavour="fanuc"))
    assert errors(faults) == ()
    assert len(program) == 301


def test_the_limit_of_blocks_is_exact():
    text = "o1 repeat [3]\nX1\nY1\no1 endrepeat\n"  # 1 + 3 * 3 blocks
    assert execute(scan_by_block(text, "part.ngc")[0], ExecutionLimits(blocks=10))[1] == ()
    assert faults_of(text, blocks=9)[0][0] == "G313"


@pytest.mark.parametrize("block", ["X[" + "+".join(["1"] * 90) + "]", "G1 " * 400, "M98 P7" + " G1" * 400])
def test_long_blocks_in_endless_loops_end_by_operations(block):
    (fault,) = faults_of(f"o1 while [1]\n{block}\no1 endwhile\nM2\nO7\nM99\n", operations=10_000)
    assert (fault[0], fault[3]) == ("G313", "more than 10000 operations in executed blocks")


def test_levels_are_limited():
    text = "o<a> sub\no1 if [#1 gt 0]\no<a> call [#1-1]\no1 endif\no<a> endsub\no<a> call [%d]\nX1\n"
    assert execute(scan_by_block(text % 8, "part.ngc")[0])[1] == ()
    assert faults_of(text % 9) == [("G314", 3, 0, "more than 10 levels, the main program included")]


def test_levels_of_m98_are_limited():
    assert faults_of("M98 P7\nM2\nO7\nM98 P7\nM99\n")[0][:2] == ("G314", 4)


def test_levels_do_not_rest_on_pythons_stack():
    deep = 5000
    text = f"o<a> sub\no1 if [#1 gt 0]\no<a> call [#1-1]\no1 endif\no<a> endsub\no<a> call [{deep}]\nX1\n"
    plain, faults = execute(scan_by_block(text, "part.ngc")[0], ExecutionLimits(depth=deep + 2))
    assert faults == ()
    assert len(plain) == 1


def program_by_chance(chance, depth=3):
    """Blocks within frames, the frames well nested, the blocks not always in their place."""
    text = ""
    for _ in range(chance.randint(1, 3)):
        label = chance.randint(100, 10**9)
        if depth and chance.random() < 0.5:
            inner = program_by_chance(chance, depth - 1).replace("{0}", str(label))
            text += chance.choice(FRAMES).replace("{1}", inner).replace("{0}", str(label))
        else:
            text += chance.choices(BLOCKS, [len(BLOCKS)] * (len(BLOCKS) - 6) + [1] * 6)[0] + "\n"
    return text


@pytest.mark.slow
def test_programs_put_together_by_chance_end_in_blocks_or_faults():
    chance = random.Random(274)
    outcomes = set()
    for _ in range(cases(200)):
        parts = [program_by_chance(chance) for _ in range(3)]
        text = "{}o7 sub\n{}o7 endsub\nM2\nO5\n{}M99\n".format(*parts).replace("{0}", "9")
        plain, faults = execute(scan_by_block(text, "part.ngc")[0], ExecutionLimits(blocks=100))
        assert (plain is None) == bool(faults), text
        outcomes |= {fault.code for fault in faults} or {"blocks"}
    assert outcomes >= {"blocks", "G301", "G302", "G304", "G307", "G309", "G312", "G313", "G314"}


class Label(str):
    """A label that counts how often labels are compared or looked up."""

    looked_up = 0

    def __hash__(self):
        Label.looked_up += 1
        return super().__hash__()

    def __eq__(self, other):
        Label.looked_up += 1
        return super().__eq__(other)


@pytest.mark.parametrize("close", ["closed", "outer closed", "open", "with jumps"])
def test_o_words_within_each_other_are_linked_in_linear_work(close):
    count = 2000
    opens = [OWord("while", Label(number), ()) for number in range(count)]
    ends = [OWord("endwhile", Label(number), ()) for number in reversed(range(count))]
    jumps = [OWord("break", Label(number), ()) for number in range(count)]
    words = opens + {"closed": ends, "outer closed": ends[-1:], "open": [], "with jumps": jumps + ends}[close]
    Label.looked_up = 0
    flow, faults = link_o_words(dict(enumerate(words)))
    assert Label.looked_up < 50 * len(words)
    assert len(flow.last_row) == (count if close == "with jumps" else 0)
    reported = {"closed": 0, "outer closed": 1, "open": count, "with jumps": 0}
    assert [fault.code for _, fault in faults] == ["G308"] * reported[close]
