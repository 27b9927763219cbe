# SPDX-License-Identifier: LGPL-2.1-or-later
"""Columns against the plain way: both read the same Program from programs made by hypothesis."""

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st
from reference import resolve_by_block

from pkm_post.model import Tool
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.gcode.resolve import resolve
from pkm_post.reading.gcode.scan import scan

NANOMETRE = 1e-6
TOOLS = {1: Tool(1, "", 10.0, 0.0, 60.0), 2: Tool(2, "", 5.0, 0.0, 90.0)}
ORIGINS = {f"G{number}": (0.0, 0.0, 0.0, 0.0) for number in (54, 55, 56)}

number = st.integers(-9000, 9000).map(lambda thousandths: f"{thousandths / 1000:.3f}")
size = st.integers(1000, 9000).map(lambda thousandths: thousandths / 1000)


@st.composite
def words(draw, letters="XYZ"):
    chosen = draw(st.lists(st.sampled_from(letters), min_size=1, max_size=len(letters), unique=True))
    return " ".join(letter + draw(number) for letter in sorted(chosen))


@st.composite
def arcs(draw):
    plane, (first, second, third), (i, j) = draw(
        st.sampled_from([("G17", "XYZ", "IJ"), ("G18", "ZXY", "KI"), ("G19", "YZX", "JK")])
    )
    sense, helix = draw(st.sampled_from(["G2", "G3"])), draw(st.sampled_from(["", f" {third}1.5"]))
    radius, turns = draw(size), draw(st.sampled_from(["", " P1", " P3"]))
    end = draw(st.sampled_from([None, (1.0, 1.0), (2.0, 0.0), (1.0, -1.0)]))
    if end is None:
        return [f"{plane} G91", f"{sense}{helix} {i}{radius} {j}0{turns}", "G90 G17"]
    to = f"{first}{end[0] * radius} {second}{end[1] * radius}{helix}"
    if draw(st.booleans()):
        return [f"{plane} G91", f"{sense} {to} R{draw(st.sampled_from([1, -1])) * 2 * radius}", "G90 G17"]
    return [f"{plane} G91", f"{sense} {to} {i}{radius} {j}0{turns}", "G90 G17"]


@st.composite
def drilling(draw):
    plane, across, normal = draw(st.sampled_from([("G17", "XY", "Z"), ("G18", "XZ", "Y"), ("G19", "YZ", "X")]))
    retract = draw(st.sampled_from(["G98", "G99"]))
    hole = f"{plane} {retract} G81 {draw(words(across))} {normal}-9.5 R{draw(st.sampled_from([-3, 4]))}"
    relative = f"G91 {hole.replace('R-3', 'R-1').replace('R4', 'R-1')} L3"
    other = draw(st.sampled_from([[], [f"G98 {across[0]}2"], [f"G99 {across[0]}2", f"G98 R-2 {across[1]}1 L2"]]))
    more = [draw(words(across)), *other, draw(words(across)), "G80 G90 G17"]
    return draw(st.sampled_from([[hole, *more], [relative, *more]]))


lines = st.one_of(
    st.tuples(st.sampled_from(["G0 ", "G1 ", "G1 F500 ", "G1 M8 "]), words()).map(lambda pair: ["".join(pair)]),
    st.lists(words(), min_size=1, max_size=4).map(lambda many: ["G1", *many]),
    st.lists(words(), min_size=1, max_size=4).map(lambda many: ["G91 G1", *many, "G90"]),
    arcs(),
    arcs(),
    drilling(),
    words().map(lambda text: ["G20", f"G1 {text} F20", "G21 F300"]),
    words().map(lambda text: [f"G93 G1 {text} F5", f"{text} F2", "G94 F200"]),
    words().map(lambda text: ["M3", f"G95 G1 {text} F.5", "G94 F200"]),
    words().map(lambda text: [f"G92 {text}"]),
    words().map(lambda text: [f"G52 {text}"]),
    st.tuples(st.sampled_from([1, 2, 3]), words(), st.sampled_from(["", " R30", " R-75.5"])).map(
        lambda parts: [f"G10 L2 P{parts[0]} {parts[1]}{parts[2]}"]
    ),
    st.sampled_from(["G54", "G55", "G56", "G43 H1", "G43 H2", "G49", "G69", "G50.1", "G61", "G64"]).map(lambda w: [w]),
    st.sampled_from(["G61.1", "G64 P.02", "G64 Q.5 P1.25"]).map(lambda w: [w]),
    words().map(lambda text: ["G20 G64 P.25", f"G1 {text}", "G21"]),
    st.sampled_from(["T1 M6", "T2 M6", "T2", "S500", "M3 S900", "M4", "M7", "M9", "G4 P.5"]).map(lambda w: [w]),
    words("XY").map(lambda text: [f"G51.1 {text}"]),
    st.tuples(number, number, number).map(lambda text: ["G68 X{} Y{} R{}".format(*text)]),
    words().map(lambda text: ["G41.1 D6", f"G1 {text}", "G40"]),
    words().map(lambda text: ["G42.1 D3", f"G1 {text}", text, "G40"]),
)
programs = st.lists(lines, min_size=1, max_size=25).map(
    lambda parts: "\n".join(["T1 M6", "S800 M3", "G0 X1 Y2 Z3", "G1 F100", *sum(parts, []), ""])
)


def same(text, axis_words="none"):
    blocks, faults = scan(text, "part.ngc")
    assert not faults
    read, faults = resolve(blocks, ReadOptions(tools=TOOLS, work_offsets=ORIGINS, axis_words=axis_words))
    assert read is not None, faults
    rows, events = resolve_by_block(blocks, TOOLS)
    assert len(read) == len(rows)
    for name in ("line", "kind", "exact_stop", "exact_path", "tip_tolerance", "plane"):
        assert getattr(read, name).tolist() == [row[name] for row in rows], name
    for name in ("position", "tool_axis", "arc_centre", "arc_axis", "side_offset", "normal"):
        np.testing.assert_allclose(getattr(read, name), np.array([row[name] for row in rows]), rtol=0, atol=NANOMETRE)
    feed = np.array([row["feed"] for row in rows])
    goes = feed != 0  # with G93 a block that goes nowhere has none
    np.testing.assert_allclose(read.feed[goes], feed[goes], rtol=1e-9)
    assert [(event.row, int(event.kind), event.value) for event in read.events] == events


@pytest.mark.slow
@seed(20240611)
@settings(deadline=None, derandomize=False, database=None)
@given(programs)
def test_same_program(text):
    same(text)


@seed(20240612)
@settings(deadline=None, database=None)
@given(st.lists(st.one_of(
    st.tuples(number, size, number, words()).map(lambda w: f"G1 {w[3]} I{w[0]} J{w[1]} K{w[2]}"),
    words().map(lambda text: f"G1 {text}"),
    st.tuples(number, size, number).map(lambda w: f"G1 I{w[0]} J{w[1]} K{w[2]}"),
    st.tuples(number, size, number, words()).map(lambda w: f"LN {w[3]} TX{w[0]} TY{w[1]} TZ{w[2]}"),
    st.tuples(number, size, words()).map(lambda w: f"LN {w[2]} NX{w[0]} NY{w[1]} NZ0"),
    number.map(lambda degrees: f"G68 X1 Y2 R{degrees}"),
    words("XY").map(lambda text: f"G51.1 {text}"),
    st.just("G3 X1 I2"),
), min_size=1, max_size=30))  # fmt: skip
@pytest.mark.slow
def test_same_program_with_tool_axes(parts):
    text = "\n".join(["T1 M6", "G43.5 H1", "G0 X1 Y2 Z3", "G1 F100", *parts, ""])
    same(text.replace("G3 X1 I2", "G91 G3 X2 I1 J0\nG90"), "vector")
