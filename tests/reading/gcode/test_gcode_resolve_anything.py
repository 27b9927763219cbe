# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whatever blocks are put together, they give a program or faults: no exception, no warning, no number that is none."""

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from pkm_post.model import Kind, Tool
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import G_CODES, M_CODES, UNSUPPORTED
from pkm_post.reading.gcode.options import AXIS_WORDS, ReadOptions
from pkm_post.reading.gcode.resolve import resolve

TOOLS = {number: Tool(number, "", 6.0 * number, 0.0, 50.0 + number) for number in (1, 2)}
OFFSETS = {"G54": (1.0, 2.0, 3.0, 0.0), "G55": (0.0, 0.0, 9.0, 30.0)}

values = st.one_of(
    st.sampled_from([0.0, 1.0, 2.0, 3.0, 5.0, 0.5, -1.0, 20.0, 1e-9, 1e9, 1e300, -1e30]),
    st.floats(-50, 50),
)
words = st.dictionaries(st.sampled_from("ABCDFHIJKLPQRSTXYZ"), values, max_size=6)
likely = st.dictionaries(st.sampled_from("FPRXYZ"), st.sampled_from([1.0, 2.0, 3.0, 0.5]), max_size=4)
g_codes = st.lists(st.sampled_from([*sorted(G_CODES), 50, 123]), max_size=2)
m_codes = st.lists(st.sampled_from([*sorted(M_CODES), 77]), max_size=1)
blocks = st.lists(st.tuples(st.one_of(words, likely), g_codes, m_codes, st.booleans()), max_size=12)
START = ({"X": 1.0, "Y": 2.0, "Z": 3.0, "F": 100.0, "S": 500.0, "T": 1.0}, [0], [3], False)


def table(rows):
    letters = {letter for row in rows for letter in row[0]}
    columns = {letter: np.array([row[0].get(letter, np.nan) for row in rows]) for letter in letters}
    g_row, m_row = (np.repeat(np.arange(len(rows)), [len(row[which]) for row in rows]) for which in (1, 2))
    g, m = (sum((row[which] for row in rows), []) for which in (1, 2))
    lines = np.arange(len(rows)) + 1
    return Blocks(lines, columns, g, g_row, m, m_row, [row[3] for row in rows], {}, (), "part.ngc")


@pytest.mark.slow
@pytest.mark.parametrize("axis_words", AXIS_WORDS)
@seed(7)
@settings(deadline=None, database=None)
@given(blocks, st.booleans(), st.booleans())
def test_a_program_or_faults(axis_words, rows, started, known):
    options = ReadOptions(
        tools=TOOLS,
        axis_words=axis_words,
        work_offsets=OFFSETS if known else {},
        home=(0.0, 0.0, 9.0) if known else None,
        start=(0.0, 0.0, 0.0) if known else None,
        block_delete=known,
    )
    program, faults = resolve(table([START, *rows] if started else rows), options)
    assert faults or program is not None
    assert list(faults) == sorted(faults, key=lambda fault: (fault.place.line, fault.code))
    if program is None:
        return
    assert np.isfinite(program.position).all() and np.isfinite(program.side_offset).all()
    np.testing.assert_allclose(np.linalg.norm(program.tool_axis, axis=1), 1.0, rtol=1e-12)
    arc, rapid = program.kind == Kind.ARC, program.kind == Kind.RAPID
    assert np.isfinite(program.arc_centre[arc]).all() and np.isnan(program.arc_centre[~arc]).all()
    np.testing.assert_allclose(np.linalg.norm(program.arc_axis[arc], axis=1), 1.0, rtol=1e-12)
    assert (program.feed[~rapid] > 0).all() and np.isnan(program.feed[rapid]).all()
    assert all(0 <= event.row <= len(program) for event in program.events)
    assert [event.row for event in program.events] == sorted(event.row for event in program.events)


def test_no_code_is_supported_and_refused():
    names = {f"G{code / 10:g}" for code in G_CODES} | {f"M{code}" for code in M_CODES}
    assert not names & set(UNSUPPORTED)
