# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scan: what blocks hold, and that the fast way and the way through lark alone are one; where a file ends."""

import random

import numpy as np
import pytest
from by_block import scan_by_block
from hypothesis import given, settings
from hypothesis import strategies as st

from pkm_post.reading.gcode import ReadOptions, read
from pkm_post.reading.gcode import scan as scan_module
from pkm_post.reading.gcode.blocks import LONGEST_LINE, Blocks
from pkm_post.reading.gcode.scan import scan

PROGRAM = "G0 X0 Y0 Z5.\nG1 Z-1. F100\n"
WAYS = pytest.mark.parametrize("way", [scan, scan_by_block])


def scanned(text):
    blocks, diagnostics = scan(text, "part.ngc")
    assert diagnostics == ()
    return blocks


def assert_same(one, other):
    assert one[1] == other[1]
    if one[0] is None or other[0] is None:
        assert one[0] is other[0]
        return
    for name in ("line", "g", "g_row", "m", "m_row", "deleted"):
        np.testing.assert_array_equal(getattr(one[0], name), getattr(other[0], name), err_msg=name)
    assert list(one[0].words) == list(other[0].words)
    for letter in one[0].words:
        np.testing.assert_array_equal(one[0].word(letter), other[0].word(letter), err_msg=letter)
    assert one[0].special == other[0].special
    assert one[0].comments == other[0].comments
    assert one[0].source == other[0].source


def test_a_block_has_words_and_codes():
    blocks = scanned("G21 G90\nN20 G1 X1.5 Y-2 F300 M3 M8\n")
    assert blocks.line.tolist() == [1, 2]
    assert blocks.g_of(0).tolist() == [210, 900]
    assert blocks.g_of(1).tolist() == [10]
    assert blocks.m_of(1).tolist() == [3, 8]
    assert blocks.words_of(1) == {"X": 1.5, "Y": -2.0, "F": 300.0}


@pytest.mark.parametrize(
    "code, tenths", [("G1", 10), ("g01", 10), ("G 1", 10), ("G1.", 10), ("G43.4", 434), ("G59.30", 593)]
)
def test_g_codes_are_kept_in_tenths(code, tenths):
    assert scanned(f"{code} X1").g.tolist() == [tenths]


@pytest.mark.parametrize(
    "number, value", [("5", 5.0), ("+.5", 0.5), ("5.", 5.0), ("-0", 0.0), ("-0012.250", -12.25), ("  16.3", 16.3)]
)
def test_numbers_are_read_in_every_form(number, value):
    assert scanned(f"X{number}").word("X")[0] == value


def test_lines_that_say_nothing_are_no_rows():
    blocks = scanned("%\n\nN10\n  (a comment)\n/\n; another\nG0\n%\n")
    assert blocks.line.tolist() == [7]


def test_block_delete_is_reported():
    assert scanned("/N10 G1 X1\nG1 X2\n/ #1=2\n").deleted.tolist() == [1 << 1, 0, 1 << 1]


def test_a_numbered_switch_deletes_its_block_and_is_no_number_of_it():
    blocks = scanned("/2 G1 X1 Y3\n/ 9N10 X2\n/1\nX4 (/3)\n/3 #1=8/2\n/4N8 X[8/2]\n")
    assert blocks.line.tolist() == [1, 2, 4, 5, 6]
    assert blocks.deleted.tolist() == [1 << 2, 1 << 9, 0, 1 << 3, 1 << 4]
    assert blocks.word("X")[:3].tolist() == [1, 2, 4] and blocks.word("Y")[0] == 3


def test_several_switches_may_delete_a_block():
    blocks = scanned("/1/3 G1 X1\n/1 /9N10 X2\n/2/2X3\n/4 /3 X[4]\n")
    assert blocks.deleted.tolist() == [1 << 1 | 1 << 3, 1 << 1 | 1 << 9, 1 << 2, 1 << 4 | 1 << 3]


@pytest.mark.parametrize(
    "line", ["//3 X1", "//X1", "/1/ X1", "X1 /Y2 /3 Z4", "X1 /0 Y2", "/0 X1", "/10 X1", "/2.5 X1", "/-2 X1", "/2 3 X1"]
)
def test_other_numbers_after_a_slash_are_no_switch(line):
    blocks, faults = scan(f"{line}\n", "part.ngc")
    assert blocks is None and [fault.place.line for fault in faults] == [1]


@pytest.mark.parametrize(
    "line, kind",
    [
        ("#1=2", "assignment"),
        ("G1 X[#1+2]", "word"),
        ("O100 sub", "o_word"),
        ("A3=[0+1] B3=0 C3=1", "named_word"),
        ("LN X1 Y2 Z3 NX#1 NY0 NZ1", "surface_word"),
    ],
)
def test_blocks_with_more_than_plain_words_keep_their_tree(line, kind):
    blocks = scanned(f"G0 X0\n{line}\nG1 X1\n")
    assert list(blocks.special) == [1]
    assert kind in {child.data for child in blocks.special[1].children if not isinstance(child, str)}
    assert blocks.words_of(1) == {}
    assert len(blocks.g_of(1)) == len(blocks.m_of(1)) == 0


@pytest.mark.parametrize(
    "expression, tree",
    [
        ("2**3**2", "((2 ** 3) ** 2)"),
        ("1+2*3", "(1 + (2 * 3))"),
        ("1-2-3", "((1 - 2) - 3)"),
        ("6 mod 4/2", "((6 mod 4) / 2)"),
        ("1 lt 2 and 3 ge 2+1", "((1 lt 2) and (3 ge (2 + 1)))"),
        ("-2**2", "(-2 ** 2)"),
        ("[1+2]*3", "((1 + 2) * 3)"),
    ],
)
def test_operators_bind_as_in_rs274ngc(expression, tree):
    def written(branch):
        if isinstance(branch, str):
            return str(branch)
        inside = " ".join(written(child) for child in branch.children)
        return inside if branch.data == "bracketed" else f"({inside})"

    (assignment,) = scanned(f"#1=[{expression}]").special[0].children
    assert written(assignment.children[1]) == tree


@pytest.mark.parametrize(
    "line, g, words",
    [
        ("TRAORI(1)", [435], {}),
        ("G1 X2 A3=0.5 b 3=-1 C3 = 2", [10], {"X": 2, "A3": 0.5, "B3": -1, "C3": 2}),
        ("LN X1 NX0 N Y-1 tz1", [435, 10], {"X": 1, "NX": 0, "NY": -1, "TZ": 1}),
    ],
)
def test_words_of_other_dialects_are_plain(line, g, words):
    for way in (scan, scan_by_block):
        blocks, faults = way(f"G0 X0\n{line}\n", "part.ngc")
        assert not faults and not blocks.special
        assert blocks.g_of(1).tolist() == g
        assert blocks.words_of(1) == words


@pytest.mark.parametrize("line", ["L N X1", "TRA ORI", "T RAFOOF", "L N X1 NX1"])
def test_keywords_have_no_blanks_inside(line):
    for text in (line, f"LN X1\nTRAORI\nTRAFOOF\nLN NX1 X1\n{line}"):
        one, other = scan(text, "part.ngc"), scan_by_block(text, "part.ngc")
        assert one[0] is None
        assert_same(one, other)


def test_comments_that_speak_are_kept():
    blocks = scanned("(MSG, mind the clamp)\nG0 X1 (rapid)\n(msg,h\xe9)\n; TOOL 3: ball 6 mm\n(DEBUG,#1)\n; T5 (6 mm)")
    assert blocks.comments == (
        (1, "MSG, mind the clamp"),
        (3, "msg,h\xe9"),
        (4, "TOOL 3: ball 6 mm"),
        (5, "DEBUG,#1"),
        (6, "T5 (6 mm)"),
    )


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1"])
def test_encodings_of_comments_do_not_matter(encoding):
    assert scanned("(MSG, K\xfchlung)\r\nG1 X1\r\n".encode(encoding)).comments == ((1, "MSG, K\xfchlung"),)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_line_ends_do_not_matter(end):
    assert_same(scan(f"G1 X1{end}{end}Y2{end}M30", "f"), scan("G1 X1\n\nY2\nM30\n", "f"))


def test_a_line_of_ten_megabytes_is_one_fault():
    blocks, diagnostics = scan("G1 X1\n" + "Y2" * 5_000_000 + "\nG1 X$", "part.ngc")
    assert blocks is None
    assert [(fault.code, fault.place.line) for fault in diagnostics] == [("G104", 2), ("G101", 3)]


def test_the_longest_line_is_a_block():
    comment = "(" + "x" * (LONGEST_LINE - 4) + ")"
    assert len(scanned(f"X1{comment}")) == 1
    assert_same(scan(f"X1 {comment}\nX2", "f"), scan_by_block(f"X1 {comment}\nX2", "f"))


def test_faults_of_lines_that_differ_in_numbers_alone_are_counted():
    _, diagnostics = scan("".join(f"G1 X1..{n}\n" for n in range(4000)) + "X\n", "part.ngc")
    assert [(fault.code, fault.place.line) for fault in diagnostics] == [
        *(("G102", line) for line in range(1, 7)),
        ("G201", 4001),
    ]
    assert diagnostics[-2].found == "'1..5', and 3994 more like it"


def test_faults_of_a_hundred_shapes_are_reported_and_the_others_counted():
    letters = [first + second for first in "ABCDEFGHIJKL" for second in "XYZABCDEFGH"]  # one is AA, another BB, ...
    _, diagnostics = scan("\n".join(letters[:130]), "part.ngc")
    assert [fault.code for fault in diagnostics] == ["G201"] * 100 + ["G199"]
    assert diagnostics[-1].found == "and 30 more"


def test_columns_count_characters_not_bytes():
    for encoding in ("utf-8", "latin-1"):
        (fault,) = scan("(K\xfchlung) X$".encode(encoding), "part.ngc")[1]
        assert (fault.place.column, fault.found) == (12, "'$'")


def test_blocks_refuse_columns_of_another_length():
    blocks = scanned("G1 X1\nX2")
    with pytest.raises(ValueError, match=r"Blocks.words X: expected \(2,\), got \(1,\)"):
        Blocks(np.array([1, 2]), {"X": blocks.word("X")[:1]}, [10], [0], [], [], [False, False], {}, (), "f")


DIGITS = st.text("0123456789", min_size=1, max_size=4)
NUMBERS = st.builds(
    "{}{}".format,
    st.sampled_from(["", "", "-", "+"]),
    st.one_of(DIGITS, DIGITS.map("{}.".format), DIGITS.map(".{}".format), st.builds("{}.{}".format, DIGITS, DIGITS)),
)
MALFORMED = st.sampled_from(
    ["1.2.3", "1-2", "-", "", ".", "--1", "1..", "5 6", "+-3", "1e5", "9" * 400, "$", "\x00", "\xe9"]
)
LETTERS = st.sampled_from("ABCDEFHIJKLMNOPQRSTUVWXYZabcxyzfn")
CODES = st.sampled_from(["G1", "g01", "G 2", "G43.4", "G90", "G17", "M3", "m08", "M 6", "G1.25", "G-1", "M3.5"])
BLANKS = st.sampled_from(["", "", " ", "  ", "\t", "(c)", "( ; )", "(MSG, here)"])
PLAIN = st.builds("{}{}{}".format, LETTERS, BLANKS, st.one_of(NUMBERS, NUMBERS, NUMBERS, NUMBERS, MALFORMED))
SPECIAL = st.sampled_from(
    ["#1=2", "X[#1+2]", "#<a-b>=-#5", "O100 sub", "o<f> call [1] [-2]", "A3=.5", "B 3 = 1", "LN", "NX1", "TRAORI(1)"]
    + ["X-[1-2]", "#1=[1 -2]", "#1=[1 2]", "TRA ORI", "O1000", "A4=1", "[", "]", "(", ")", "(a (b) c)", "; (", "%", "/"]
)
BLOCKS = st.builds(
    "{}{}{}{}".format,
    st.sampled_from(["", "", "", "/", " / ", "%"]),
    st.sampled_from(["", "N10 ", "n010", "N5.5 ", "N-1", "N1.2.3"]),
    st.lists(st.one_of(PLAIN, PLAIN, PLAIN, CODES, CODES, SPECIAL, BLANKS), max_size=6).flatmap(
        lambda words: st.lists(BLANKS, min_size=len(words), max_size=len(words)).map(
            lambda blanks: "".join(word + blank for word, blank in zip(words, blanks, strict=True))
        )
    ),
    st.sampled_from(["", "", ";end", " ", "(T1 D=6)"]),
)
PROGRAMS = st.builds(
    lambda blocks, end: end.join(blocks), st.lists(BLOCKS, max_size=8), st.sampled_from(["\n", "\r\n"])
)


@pytest.mark.slow
@settings(derandomize=True, deadline=None)
@given(PROGRAMS)
def test_both_ways_give_the_same(program):
    assert_same(scan(program, "part.ngc"), scan_by_block(program, "part.ngc"))


@pytest.mark.slow
@settings(derandomize=True, deadline=None)
@given(PROGRAMS)
def test_both_ways_give_the_same_of_the_lines_that_are_good(program):
    good = "\n".join(line for line in program.splitlines() if scan(line, "part.ngc")[0] is not None)
    one = scan(good, "part.ngc")
    assert {fault.code for fault in one[1]} <= {"G212"}  # behind a percent sign
    assert_same(one, scan_by_block(good, "part.ngc"))


@pytest.mark.parametrize("block", ["M[2.3]", "M[2+0.3]", "G[1.04]", "G[1-2]", "G[1] X[2]", "X[3] Y2", "G1 X[#1]"])
def test_both_ways_give_the_same_of_numbers_in_brackets(block):
    assert_same(scan(f"X1\n{block}\nX2", "part.ngc"), scan_by_block(f"X1\n{block}\nX2", "part.ngc"))


def test_pieces_do_not_show(monkeypatch):
    chance = random.Random(20)
    program = "\n".join(
        f"N{row} G{row % 4} X{chance.uniform(-9, 9):.4f} (c) #1={row}"[: chance.randint(0, 40)] for row in range(400)
    )
    whole = scan(program, "part.ngc")
    monkeypatch.setattr(scan_module, "PIECE", 100)
    assert_same(scan(program, "part.ngc"), whole)


def test_numbers_are_the_nearest_doubles():
    chance = random.Random(21)
    texts = [f"{chance.uniform(-1, 1) * 10 ** chance.randint(-6, 12):.{chance.randint(0, 17)}f}" for _ in range(3000)]
    blocks = scanned("\n".join(f"X{text}" for text in texts))
    assert blocks.word("X").tolist() == [float(text) for text in texts]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_any_bytes_give_blocks_or_diagnostics(seed):
    chance = random.Random(seed)
    alphabet = [bytes(range(256)), b"GXYZMNO#[]()<>=;/%. -+0123456789\n\r\t", b"GX1 .-\n", b"O1 subcallwhi[#1lt2]\n"][
        seed
    ]
    for _ in range(300):
        text = bytes(chance.choices(alphabet, k=chance.randint(0, 120)))
        blocks, diagnostics = scan(text, "noise.ngc")
        assert (blocks is None) == bool(diagnostics)
        assert_same((blocks, diagnostics), scan_by_block(text, "noise.ngc"))


@WAYS
@pytest.mark.parametrize("name", ["prog1", "PM", "1000", "O1234 (part)", "A_b-2.nc ; x"])
def test_the_name_of_a_program_may_follow_the_percent_sign_at_its_beginning(way, name):
    """FreeCAD's post for UCCNC writes %prog1."""
    blocks, faults = way(f"(a)\n\n%{name}\n{PROGRAM}", "part.ngc")
    assert faults == () and blocks.line.tolist() == [4, 5]


@WAYS
@pytest.mark.parametrize("text", ["%G1 X1\n", "%X10\n", "%prog1 X1\n", "G0 X1\n%prog1\n", "%\n%prog1\n"])
def test_nothing_else_may(way, text):
    assert way(text + PROGRAM, "part.ngc")[0] is None


@WAYS
@pytest.mark.parametrize(
    ("text", "closed"),
    [
        (PROGRAM, False),
        (f"%\n{PROGRAM}", False),
        (f"%\n{PROGRAM}%", True),
        (f"%\n{PROGRAM}%\n", True),
        (f"{PROGRAM}%\n", True),
        (f"\n(of 50 % aluminium)\n  % (leader)\n{PROGRAM}\t%; done\n", True),
        (f"%\n%\n(two leaders)\n{PROGRAM}", False),
        (f"PART 4711, Mr Smith's\n%\n{PROGRAM}%\n", True),  # label skip
        (f"\0\0\0%\n{PROGRAM}%\n\0\0", True),  # a tape
        (f"%\n{PROGRAM}(100 %)\n; 100%\n", False),
    ],
)
def test_a_percent_sign_after_a_block_closes_a_file(way, text, closed):
    for content in (text, text.replace("\n", "\r\n"), text.encode()):
        blocks, diagnostics = way(content, "part.ngc")
        assert (blocks.closed, diagnostics) == (closed, ())


@WAYS
@pytest.mark.parametrize("after", ["G0 X500\n", "(lost)\n\nwhatever [ is here\n", "%\nG0 X500\n%\n"])
def test_blocks_after_the_end_are_reported_and_not_read(way, after):
    blocks, (diagnostics,) = way(f"%\n{PROGRAM}%\n{after}", "part.ngc")
    lines = f"%\n{PROGRAM}%\n{after}".splitlines()
    first = next(number for number, line in enumerate(lines, 1) if number > 4 and line[:1] not in ("", "(", "%"))
    assert (diagnostics.code, diagnostics.place.line, diagnostics.found) == ("G212", first, lines[first - 1])
    assert blocks.line.tolist() == [2, 3]


@WAYS
def test_nothing_is_reported_of_an_empty_trailer(way):
    assert way(f"{PROGRAM}M2\n%\n\n(end of tape)\n%\n", "part.ngc")[1] == ()


@pytest.mark.parametrize(
    ("text", "ends"),
    [
        ("M2\n", True),
        ("M30\n", True),
        ("%\n", True),
        ("", False),
        ("M0\n", False),
        ("(M2)\n", False),
        ("o1 if [1]\nM2\no1 endif\n", True),
        ("o1 if [0]\nM2\no1 endif\n", False),
        ("#1=2\nM#1\n", True),
        ("M98 P7\nO7\nG0 Z5.\nM99\n", False),
        ("M98 P7\nM30\nO7\nG0 Z5.\nM99\n", True),
        ("#1=1\nG0 Z[#1]\n%\n", True),
    ],
)
def test_a_whole_program_has_an_end_that_is_come_to(text, ends):
    program, diagnostics = read(PROGRAM + text, "part.ngc", ReadOptions(needs_end=True))
    codes = [each.code for each in diagnostics]
    assert codes == ([] if ends else ["G430"])
    assert (program is not None) == ends


def test_a_line_by_hand_needs_no_end():
    assert read(PROGRAM, "MDI")[1] == ()
