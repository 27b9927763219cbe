# SPDX-License-Identifier: LGPL-2.1-or-later
from pkm_post.writing.controllers.pvt.writer import comment_lines


def test_only_printable_ascii_reaches_the_controller():
    # ^A (abort) and ^K (kill all motors) act on the controller even within a comment.
    assert comment_lines("Säule \x01\x0b\n床", 159) == [r"; S\xe4ule \x01\x0b\n\u5e8a"]


def test_a_long_text_is_folded_at_the_line_limit():
    lines = comment_lines("x" * 100, 40)
    assert max(map(len, lines)) == 40
    assert "".join(line.removeprefix("; ") for line in lines) == "x" * 100


def test_an_empty_line_stays_a_comment():
    assert comment_lines("", 40) == [";"]
