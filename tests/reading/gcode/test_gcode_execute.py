# SPDX-License-Identifier: LGPL-2.1-or-later
"""Execution: what a program does, in which order, and with which lines."""

import time

import numpy as np
import pytest
from by_block import scan_by_block
from executed import execute

from pkm_post.reading.gcode.options import ExecutionLimits

LONG_LOOP = 100_000
BOUND = 60.0  # s, far above what it takes, and far below what a hang takes


def scanned(text):
    blocks, faults = scan_by_block(text, "part.ngc")
    assert faults == ()
    return blocks


def executed(text, **options):
    blocks, faults = execute(scanned(text), **options)
    assert faults == ()
    assert blocks.special == {}
    return blocks


def shown(blocks):
    """The blocks as text: line, codes and words."""
    return [
        " ".join(
            [
                f"{blocks.line[row]}:",
                *(f"G{code / 10:g}" for code in blocks.g_of(row)),
                *(f"M{code}" for code in blocks.m_of(row)),
                *(f"{letter}{value:g}" for letter, value in blocks.words_of(row).items()),
            ]
        )
        for row in range(len(blocks))
    ]


def test_a_program_with_nothing_to_execute_is_handed_on_itself():
    blocks = scanned("G21 G90\nG0 X1 Y2\nG1 Z-1 F100\nM30\n")
    assert execute(blocks)[0] is blocks


def test_words_and_codes_get_their_values():
    assert shown(executed("#1=1 #2=55\nG#1 X[#1+1] Y-#1 F#2 M[2+1] S1000\n")) == ["2: G1 M3 F55 S1000 X2 Y-1"]


def test_half_codes_come_out_of_expressions():
    assert shown(executed("#1=59.3\nG#1\nG[43+0.1] Z1\n")) == ["2: G59.3", "3: G43.1 Z1"]


def test_plain_blocks_between_keep_words_codes_and_order():
    text = "(1)\nG21 G90 M3 S500\nG1 X1 Y2 F100\n#1=3\nG2 X0 Y0 I1 J[#1-3]\n/M8\nX4\nM30\n"
    blocks = executed(text)
    assert shown(blocks) == ["2: G21 G90 M3 S500", "3: G1 F100 X1 Y2", "5: G2 I1 J0 X0 Y0", "6: M8", "7: X4", "8: M30"]
    assert blocks.deleted.tolist() == [0, 0, 0, 1 << 1, 0, 0]


def test_blocks_of_a_loop_keep_their_lines():
    blocks = executed("o1 repeat [3]\nG1 X1\nY2\no1 endrepeat\nM2\n")
    assert blocks.line.tolist() == [2, 3, 2, 3, 2, 3, 5]


def test_codes_in_loops_stay_with_their_blocks():
    blocks = executed("#1=0\no1 repeat [2]\nG90 G1 X1 M3 M8\nY2\n#1=[#1+1]\nG#1 Z1\no1 endrepeat\n")
    once = ["3: G90 G1 M3 M8 X1", "4: Y2"]
    assert shown(blocks) == [*once, "6: G1 Z1", *once, "6: G2 Z1"]


def test_comments_and_file_name_stay():
    blocks = executed("(MSG, hello)\n#1=1\nG0 X#1\n")
    assert blocks.comments == ((1, "MSG, hello"),)
    assert blocks.source == "part.ngc"


def test_a_program_without_blocks_gives_none():
    assert len(executed("#1=1\n")) == 0


def test_m98_runs_a_program_of_the_file_several_times():
    text = "O1000\nG90 X0\nM98 P1001 L2\nX9\nM30\nO1001\nG91 X1\nM99\n"
    assert shown(executed(text)) == ["2: G90 X0", "7: G91 X1", "7: G91 X1", "4: X9", "5: M30"]


def test_a_block_with_m98_moves_before_the_call():
    assert shown(executed("G0 X1 M98 P7\nX2\nM2\nO7\nX5 M99\n")) == ["1: G0 X1", "5: X5", "2: X2", "3: M2"]


def test_nothing_is_executed_after_the_end():
    assert shown(executed("#1=1\nX#1\nM2\nX2\n")) == ["2: X1", "3: M2"]
    assert shown(executed("#1=30\nX1 M#1\nX2\n")) == ["2: M30 X1"]


def test_deleted_blocks_are_left_out_when_asked_for():
    text = "#1=1\n/#1=2\n/o1 if [0]\nX#1\n/o1 endif\n/Y5\n/M30\nZ1\n"
    assert shown(executed(text, block_delete=True)) == ["4: X1", "8: Z1"]
    assert shown(executed(text)) == ["6: Y5", "7: M30"]


def test_words_of_other_dialects_stand_for_codes():
    text = "TRAORI\nG1 X1 A3=0 B3=[0-1] C3=1\nTRAFOOF\nLN X2 TX0 TY#1 TZ1\nLN\n"
    assert shown(executed("#1=5\n" + text)) == [
        "2: G43.5",
        "3: G1 A30 B3-1 C31 X1",
        "4: G43",
        "5: G43.5 G1 TX0 TY5 TZ1 X2",
        "6: G43.5 G1",
    ]


@pytest.mark.slow
def test_a_long_loop_takes_bounded_time():
    begin = time.perf_counter()
    blocks = executed(f"#1=0\no1 while [#1 lt {LONG_LOOP}]\n#1=[#1+1]\nG1 X#1\no1 endwhile\n")
    assert time.perf_counter() - begin < BOUND
    np.testing.assert_array_equal(blocks.word("X"), np.arange(1, LONG_LOOP + 1))


def test_long_runs_are_moved_as_they_are():
    run = "".join(f"X{number}\n" for number in range(LONG_LOOP // 10))
    blocks = executed(f"o1 repeat [10]\n{run}o1 endrepeat\n")
    np.testing.assert_array_equal(blocks.word("X"), np.tile(np.arange(LONG_LOOP // 10), 10))


def test_deep_expressions_need_no_depth_of_python():
    assert shown(executed("X[" + "+".join(["1"] * 90) + "]\n")) == ["1: X90"]


def test_limits_have_to_be_positive():
    with pytest.raises(ValueError, match="depth: expected at least 1, got 0"):
        ExecutionLimits(depth=0)
