# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading: the three steps one after the other, from text to a program."""

import random
import tracemalloc

import numpy as np
import pytest
from series import cases

from pkm_post.model import Kind, Tool
from pkm_post.reading.gcode import ExecutionLimits, ReadOptions, read

OPTIONS = ReadOptions(default_tool=Tool(0, "end mill", diameter=6.0, corner_radius=0.0, length=80.0))


def codes(diagnostics):
    return [fault.code for fault in diagnostics]


def test_text_becomes_a_program():
    program, diagnostics = read("%\nG21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F600\n#1=10\nX#1\n(done)\nM2\n", "part.ngc", OPTIONS)
    assert codes(diagnostics) == []
    assert program.kind.tolist() == [Kind.RAPID, Kind.LINE, Kind.LINE]
    np.testing.assert_allclose(program.position, [[0, 0, 5], [0, 0, -1], [10, 0, -1]])
    np.testing.assert_allclose(program.feed[1:], 10.0)  # 600 mm/min
    assert program.line.tolist() == [3, 4, 6]


def test_faults_of_the_text_are_all_reported():
    program, diagnostics = read("G21\nG1 X\nG1 Y1.2.3\n", "part.ngc", OPTIONS)
    assert program is None
    assert codes(diagnostics) == ["G201", "G102"]


def test_a_loop_without_end_stops_at_its_limit():
    program, diagnostics = read("O1 while [1]\nO1 endwhile\n", "part.ngc", OPTIONS, ExecutionLimits(blocks=1000))
    assert program is None
    assert [code[:2] for code in codes(diagnostics)] == ["G3"]


@pytest.mark.slow
def test_any_text_gives_a_program_or_errors():
    chance = random.Random(7)
    words = [
        "G0",
        "G1",
        "G2",
        "G17",
        "G20",
        "G41",
        "G81",
        "G91",
        "X1",
        "Y-2",
        "Z3",
        "I1",
        "J1",
        "R2",
        "F100",
        "M3",
        "M2",
    ]
    words += [
        "#1=1",
        "X#1",
        "T1",
        "M6",
        "O1 sub",
        "O1 endsub",
        "O1 call",
        "D1",
        "P1",
        "L2",
        "G92",
        "G43.4",
        "A10",
        "\n",
        "\n",
    ]
    for _ in range(cases(150)):
        text = " ".join(chance.choices(words, k=chance.randint(0, 30)))
        program, diagnostics = read(text, "noise.ngc", OPTIONS, ExecutionLimits(blocks=1000))
        assert program is not None or diagnostics, text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("axis_words", "words", "most"), [("none", "X{} Y{} Z1", 80), ("vector", "G1 X{} Y{} Z1 I0.1 J0.2 K{}", 200)]
)
def test_memory_is_so_many_bytes_for_each_block(axis_words, words, most):
    options = ReadOptions(default_tool=OPTIONS.default_tool, axis_words=axis_words)
    peaks = []
    for count in (20_000, 80_000):
        body = "\n".join(words.format(row % 90, row % 70, row % 50 + 1) for row in range(count))
        text = f"G43.5\nG0 X0 Y0 Z0\nG1 F100\n{body}\n".encode()
        tracemalloc.start()
        program, _ = read(text, "part.ngc", options)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert len(program) == count + 1
    assert (peaks[1] - peaks[0]) / 60_000 < most  # without the text; the difference leaves out what is needed once
