# SPDX-License-Identifier: LGPL-2.1-or-later
"""Threads are tapped by a spindle that is an axis: posted, read back, measured, and refused where there is none."""

import re
import shutil
from dataclasses import replace

import numpy as np
import pytest
from machines import SPINDLE_AXIS, spindle_axis_text, text_without_jerk

from pkm_post.certificate import certify
from pkm_post.machine import forward, platform_rotation
from pkm_post.machine.description.reader import machine_of
from pkm_post.model import Event, EventKind, Kind, Refused, Tool, threads
from pkm_post.planning import plan
from pkm_post.posting import post_file, verify
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.gcode.read import read
from pkm_post.writing import trajectory_file

G_CODE = """G21 G90 G94
T1 M6
S600 M3
G0 X0. Y0. Z10.
F750
G98 G84 X30. Y5. Z-10. R2. P0.5
X40.
G80
G0 Z20.
G1 X45. F900
M5
M2
"""
"""The first hole of M8 x 1.25 has no spindle start behind it, as another one follows; the second one has."""
ARGUMENTS = "--work-offset 0,0,250 --tool-length 1=60"
_MOVE = re.compile(r"A(\S+):\S+ B(\S+):\S+ C(\S+):\S+ U(\S+):\S+ V(\S+):\S+ W(\S+?):\S+(?: Z(\S+):(\S+))?")


def posted(folder, text=G_CODE, machine=None, arguments=ARGUMENTS, name="part.ngc"):
    file, part = folder / "machine.toml", folder / name
    file.write_text(spindle_axis_text() if machine is None else machine, encoding="utf-8")
    part.write_text(text, encoding="ascii")
    return post_file(part, file, arguments=arguments, out=folder / "out")


def refusal(folder, *arguments, **options):
    with pytest.raises(Refused) as refused:
        posted(folder, *arguments, **options)
    assert not list((folder / "out").glob("*"))
    return [(fault.code, fault.place.line) for fault in refused.value.diagnostics]


@pytest.fixture(scope="module")
def tapped(tmp_path_factory):
    return posted(tmp_path_factory.mktemp("tapped"))


def machine_here(result):
    return machine_of((result.program.parent.parent / "machine.toml").read_bytes(), "machine.toml")[0]


def trajectory_of(result):
    return trajectory_file.read(result.program.with_suffix(".pkmt"))[0]


def finding(result, name):
    return next(row for row in result.report["certificate"]["findings"] if row["what"] == name)


def duration(result):
    return result.report["motion"]["duration_s"]


def test_the_spindle_is_an_axis_from_r_to_the_bottom_and_back(tapped):
    trajectory = trajectory_of(tapped)
    lead = [event for event in trajectory.events if event.kind is EventKind.SPINDLE_AXIS]
    assert [event.value for event in lead] == [1.25, 0.0, 1.25, 0.0]
    for begin, end in zip(lead[::2], lead[1::2], strict=True):
        heights = [trajectory.tip_before()[begin.row, 2], *trajectory.tip[begin.row : end.row, 2]]
        assert heights == pytest.approx([252.0, 240.0, 252.0], abs=1e-9)
    # rs274 2.9 feeds down and up as well, with the same F, and dwells at the bottom
    assert trajectory.feed[lead[0].row] == pytest.approx(12.5)
    assert Event(lead[0].row + 1, EventKind.DWELL, 0.5) in trajectory.events


def test_codes_come_in_the_order_of_the_work(tapped):
    lines = tapped.program.read_text(encoding="ascii").splitlines()
    codes = [line for line in lines if re.fullmatch(r"(S600 M3|M\d+|T\S+ M6|DWELL500)", line)]
    once = ["M29", "DWELL500", "M28"]
    assert codes == ["T1 M6", "S600 M3", *once, *once, "S600 M3", "M5"]


def test_every_line_has_the_turns_of_its_depth(tapped):
    """The depth from the six lengths of the line, by forward kinematics; the turns as they stand there."""
    machine, inside, depths, turns = machine_here(tapped), False, [], []
    lengths, tip = [], None
    for line in tapped.program.read_text(encoding="ascii").splitlines():
        inside = line == "M29" or (inside and line != "M28")
        move = _MOVE.fullmatch(line)
        if move is not None:
            assert (move[7] is not None) == inside
            if inside:
                lengths.append([float(move[number]) for number in range(1, 7)])
                turns.append(float(move[7]))
    count, tip = len(lengths), np.array([35.0, 5.0, 245.0])
    pose = forward(
        machine, np.array(lengths), np.full(count, 60.0), np.tile(tip, (count, 1)), np.tile([0, 0, 1.0], (count, 1)),
        np.zeros(count),
    )  # fmt: skip
    assert pose.converged.all()
    depths = 252.0 - pose.tip[:, 2]
    np.testing.assert_allclose(np.array(turns) * 1.25, depths, atol=1e-5)
    assert max(turns) == 9.6
    assert turns.count(9.6) == 2


def test_the_certificate_measures_lead_and_spindle(tapped):
    off, speed = finding(tapped, "depth of a thread off its turns"), finding(tapped, "spindle speed in a thread")
    assert off["value"] < 1e-4
    assert off["limit"] == 0.005
    assert 599 <= speed["value"] < 602  # as programmed, but for 0.5 % by which cubics swing about the plan
    assert finding(tapped, "spindle acceleration in a thread")["value"] <= 200.0
    machine = machine_here(tapped)
    verify(tapped.program, tapped.program.with_suffix(".pkmt"), machine)


@pytest.mark.parametrize(
    ("before", "after", "code"),
    [
        (r"(?m) Z9\.600000:0\.0000$", " Z9.610000:0.0000", "V120"),
        (r"(?m) Z9\.600000:0\.0000$", "", "C101"),
        (r"(?m)^M28\n", "", "C101"),
        (r"(?m)^M29\n", "M28\n", "C101"),
        (r"(?m) Z(\S+):(\S+)$", r" Z-\1:-\2", "V120"),
    ],
    ids=["further", "no turns", "no end", "no beginning", "the other way"],
)
def test_a_program_that_turns_otherwise_is_found(tapped, tmp_path, before, after, code):
    text = tapped.program.read_text(encoding="ascii")
    changed = (
        re.sub(before, after, text).replace("Z--", "Z").replace(":--", ":").replace("Z-0.000000:-0", "Z0.000000:0")
    )
    changed = changed.replace("-0.0000\n", "0.0000\n")
    program = tmp_path / "part.pmc"
    program.write_text(re.sub(r"(?m)^; program SHA-256.*\n", "", changed), encoding="ascii")
    with pytest.raises(Refused) as refused:
        verify(program, tapped.program.with_suffix(".pkmt"), machine_here(tapped))
    assert code in {fault.code for fault in refused.value.diagnostics}


def test_the_setup_has_the_axis_in_turns(tapped):
    lines = (tapped.program.parent / "part-setup.pmc").read_text(encoding="ascii").splitlines()
    assert "#7->36000Z" in lines
    assert [line for line in lines if line.startswith("I71")] == [
        f"I71{end}=0 ; the spindle turns without end" for end in (3, 4)
    ]


def test_without_an_axis_it_is_refused_as_before(tmp_path):
    assert refusal(tmp_path, machine=spindle_axis_text(table="", codes="")) == [("G425", 6)]


def test_a_left_hand_thread_turns_the_other_way(tmp_path):
    result = posted(tmp_path, G_CODE.replace("M3", "M4").replace("G84", "G74"))
    turns = [
        float(move[7]) for move in map(_MOVE.fullmatch, result.program.read_text().splitlines()) if move and move[7]
    ]
    assert min(turns) == -9.6
    assert max(turns) == 0.0


@pytest.mark.parametrize(
    ("before", "after", "found"),
    [
        ("G84", "G74", ("G418", 6)),
        ("S600 M3\n", "M3\n", ("G405", 3)),
        ("P0.5", "P0.5 Q2.", ("G404", 6)),
        ("Z-10.", "Z3.", ("G418", 6)),
    ],
    ids=["the spindle turns the other way", "no speed", "pecks", "a bottom above R"],
)
def test_what_has_no_meaning_is_refused(tmp_path, before, after, found):
    assert found in refusal(tmp_path, G_CODE.replace(before, after))


@pytest.mark.parametrize(
    "more", ["--also csv", "--also linuxcnc", "--also cartesian", "--copies yz", "--surface-speed 60"]
)
def test_what_has_no_spindle_axis_is_refused(tmp_path, more):
    assert [code for code, _ in refusal(tmp_path, arguments=f"{ARGUMENTS} {more}")] == ["K157"]


ANY = Tool(0, "tap", 8.0, 0.0, 60.0)
RS274 = [
    ("TRAVERSE", 30, 5, 10), ("TRAVERSE", 30, 5, 2), ("FEED", 30, 5, -10), ("FEED", 30, 5, 2), ("TRAVERSE", 40, 5, 2),
    ("FEED", 40, 5, -10), ("FEED", 40, 5, 2),
]  # fmt: skip
"""What ``rs274 -g`` of LinuxCNC 2.9 prints for the cycles below."""


def test_the_moves_are_those_of_linuxcnc():
    options = ReadOptions(default_tool=ANY, spindle_axis=True)
    text = "G21 G90 G94\nS600 M3\nG0 X0 Y0 Z10\nF750\nG99 G84 X30 Y5 Z-10 R2\nX40\nG80\nM2\n"
    program, faults = read(text, "part.ngc", options)
    assert faults == ()
    names = np.where(program.kind[1:] == Kind.RAPID, "TRAVERSE", "FEED").tolist()
    assert [(name, *point) for name, point in zip(names, program.position[1:].tolist(), strict=True)] == RS274
    assert np.all(program.feed[program.kind == Kind.LINE] == 12.5)
    assert [thread.lead for thread in threads(program.events)] == [1.25, 1.25]


RIGID = [
    ("FEED", 0, 0, 12.7),
    ("FEED", 0, 0, 25.4),
    ("FEED", 0, 0, 10.16),
    ("FEED", 0, 0, 25.4),
    ("TRAVERSE", 25.4, 0, 25.4),
]
"""The ends of RIGID_TAP below, with the way back that it has by its definition, in mm."""


def test_rigid_tapping_of_linuxcnc_goes_to_a_point_and_back():
    text = "G20 G90\nS600 M4\nG0 X0 Y0 Z1\nG91 G33.1 Z-.5 K.05\nZ-.6 K.05\nG90 G0 X1\nM2\n"
    program, faults = read(text, "part.ngc", ReadOptions(default_tool=ANY, spindle_axis=True))
    assert faults == ()
    names = np.where(program.kind[1:] == Kind.RAPID, "TRAVERSE", "FEED").tolist()
    found = [(name, *np.round(point, 9)) for name, point in zip(names, program.position[1:], strict=True)]
    assert found == RIGID
    assert [(event.row, event.kind.name, event.value) for event in program.events] == [
        (0, "SPINDLE", -600.0),
        (1, "SPINDLE_AXIS", -1.27),
        (3, "SPINDLE_AXIS", 0.0),
        (3, "SPINDLE_AXIS", -1.27),
        (5, "SPINDLE_AXIS", 0.0),
        (5, "SPINDLE", -600.0),
        (6, "SPINDLE", 0.0),
    ]
    assert np.allclose(program.feed[program.kind == Kind.LINE], 12.7)


@pytest.mark.parametrize(
    ("block", "code"),
    [
        ("G33.1 Z-8", "G405"),
        ("G33.1 Z-8 K0", "G418"),
        ("M5\nG33.1 Z-8 K1", "G418"),
        ("G33.1 Z-8 K1\nZ-9", "G418"),
        ("G33 Z-8 K1", "G425"),
        ("G93 G33.1 Z-8 K1 F1", "G441"),
    ],
)
def test_rigid_tapping_without_its_meaning_is_refused(block, code):
    text = f"G21 G90\nS600 M3\nG0 X0 Y0 Z10\n{block}\nM2\n"
    _, faults = read(text, "part.ngc", ReadOptions(default_tool=ANY, spindle_axis=True))
    assert code in [fault.code for fault in faults]
    assert [fault.code for fault in read(text, "part.ngc", ReadOptions(default_tool=ANY))[1]][:1] == ["G425"]


def test_a_slanted_thread_is_refused_and_an_upright_one_is_certified(tmp_path):
    text = "G21 G90 G94\nT1 M6\nS600 M3\nG0 X0. Y0. Z10.\nG33.1 Z-5. K1.5\nG0 Z20.\nM5\nM2\n"
    assert finding(posted(tmp_path, text), "depth of a thread off its turns")["value"] < 1e-4
    shutil.rmtree(tmp_path / "out")
    assert refusal(tmp_path, text.replace("G33.1 Z-5.", "G33.1 X1. Z-5.")) == [("K155", 5)]


def test_the_cutter_turns_with_the_depth_while_the_platform_turns_too(tapped):
    """The rotation of the cutter in {M}, from that of the platform and the turns, is that of a screw."""
    made = trajectory_of(tapped)
    first = threads(made.events)[0].first
    spun = replace(made, spin=np.linspace(0, 0.5, len(made)))
    job, faults = plan(spun, machine_here(tapped), spun.tolerances)
    assert faults == ()
    motion, turns = job.motion, job.struts.turns
    axis, start = np.array([0.0, 0.0, 1.0]), spun.spin_before()[first]
    rows = turns.knot < threads(motion.events)[0].end
    knot, angle = turns.knot[rows], 2 * np.pi * turns.angle[rows]
    assert np.ptp(motion.spin[knot]) > 0.01
    edge = platform_rotation(np.tile(axis, (len(knot), 1)), motion.spin[knot])
    # clockwise seen from the spindle is about the axis towards the tip
    of_cutter = edge @ np.array([np.cos(-angle), np.sin(-angle), np.zeros(len(knot))]).T[..., None]
    depth = spun.tip_before()[first][2] - motion.tip[knot, 2]
    screw = start - 2 * np.pi * depth / 1.25
    np.testing.assert_allclose(of_cutter[:, 0, 0], np.cos(screw), atol=1e-6)
    np.testing.assert_allclose(of_cutter[:, 1, 0], np.sin(screw), atol=1e-6)
    certificate, faults = certify(job.struts, "x", spun, machine_here(tapped), motion, spun.tolerances)
    assert faults == ()
    assert next(row.value for row in certificate.findings if row.code == "V120") < 1e-4


def test_feed_per_turn_is_the_lead(tmp_path, tapped):
    text = G_CODE.replace("F750", "G95 F1.25").replace("G80\n", "G80\nG94\n")
    assert trajectory_of(posted(tmp_path, text)).events == trajectory_of(tapped).events


def test_rigid_tapping_of_fanuc_needs_no_spindle_start(tmp_path):
    text = "%\nO1\nG21 G90 G94\nT1 M6\nG0 X30. Y5. Z10.\nM29 S600\nG98 G84 Z-10. R2. F750.\nX40.\nG80\nM30\n%\n"
    result = posted(tmp_path, text, arguments=f"{ARGUMENTS} --flavour fanuc", name="part.nc")
    assert [event.value for event in trajectory_of(result).events if event.kind is not EventKind.TOOL_CHANGE] == [
        1.25, 0.0, 1.25, 0.0,
    ]  # fmt: skip


def test_a_slow_spindle_makes_the_thread_slower_and_keeps_its_lead(tmp_path, tmp_path_factory):
    fast = posted(tmp_path_factory.mktemp("fast"), machine=text_without_jerk(spindle_axis_text()))
    table = SPINDLE_AXIS.replace("1500.0", "300.0").replace("200.0", "20.0")
    result = posted(tmp_path, machine=text_without_jerk(spindle_axis_text(table)))
    assert [fault.code for fault in result.diagnostics] == ["K156", "K156"]
    assert 280 < finding(result, "spindle speed in a thread")["value"] <= 300
    assert 10 < finding(result, "spindle acceleration in a thread")["value"] <= 20
    assert finding(result, "depth of a thread off its turns")["value"] < 1e-4
    assert duration(result) > duration(fast) + 3


def test_a_slow_spindle_makes_nothing_but_the_thread_slower(tmp_path, tmp_path_factory):
    """With limits of jerk too: rapid moves and cuts take no longer than on a machine that limits none."""
    table = SPINDLE_AXIS.replace("200.0", "20.0")
    jumping = posted(tmp_path_factory.mktemp("jumping"), machine=text_without_jerk(spindle_axis_text(table)))
    result = posted(tmp_path, machine=spindle_axis_text(table))
    assert finding(result, "spindle acceleration in a thread")["value"] <= 20
    assert duration(result) < 1.2 * duration(jumping)


def test_limits_of_jerk_keep_the_spindle_too(tmp_path):
    machine = spindle_axis_text(SPINDLE_AXIS.replace("200.0", "50.0")).replace(
        "tip_jerk = 400000.0", "tip_jerk = 20000.0"
    )
    result = posted(tmp_path, machine=machine)
    assert finding(result, "spindle acceleration in a thread")["value"] <= 50


def test_a_program_that_begins_in_a_thread_begins_with_all_of_it(tmp_path):
    result = posted(tmp_path, arguments=f"{ARGUMENTS} --from-line 7")
    lead = [event for event in trajectory_of(result).events if event.kind is EventKind.SPINDLE_AXIS]
    assert [event.value for event in lead] == [1.25, 0.0]


def test_parts_are_cut_outside_threads(tmp_path, tapped):
    text = spindle_axis_text().replace("memory_words = 237568", "memory_words = 900")
    result = posted(tmp_path, machine=text)
    parts = [file.read_text(encoding="ascii") for file in result.parts]
    assert len(parts) > 1
    assert all(part.count("\nM29\n") == part.count("\nM28\n") for part in parts)
    verify(result.program, result.program.with_suffix(".pkmt"), machine_here(result))


def test_a_trajectory_with_a_thread_aside_contradicts_itself(tapped, tmp_path):
    trajectory = trajectory_of(tapped)
    begin = next(event.row for event in trajectory.events if event.kind is EventKind.SPINDLE_AXIS)
    events = tuple(replace(event, row=event.row - (event.value == 1.25)) for event in trajectory.events)
    with pytest.raises(ValueError, match=f"thread of segment {begin - 1}"):
        trajectory_file.write(replace(trajectory, events=events), tmp_path / "x.pkmt")
    events = tuple(event for event in trajectory.events if event.kind is not EventKind.SPINDLE_AXIS or event.value)
    with pytest.raises(ValueError, match="begin and end in turn"):
        trajectory_file.write(replace(trajectory, events=events), tmp_path / "x.pkmt")


SIEMENS = """G90 G71 G17 G54
T1 M6
S500 M3
G0 X30 Y5 Z10
MCALL CYCLE84(10,2,0,-10,,0.5,{sdac},{size},{lead},0,600,300)
X30
X40
MCALL
G0 Z20
M30
"""


def siemens(folder, sdac="3", size="", lead="1.25", **options):
    return posted(folder, SIEMENS.format(sdac=sdac, size=size, lead=lead), name="part.mpf", **options)


@pytest.mark.slow
@pytest.mark.parametrize(("size", "lead"), [("", "1.25"), ("8", ""), ("8", "1.25")])
def test_cycle84_taps_with_a_speed_each_way(tmp_path, size, lead):
    result = siemens(tmp_path, size=size, lead=lead)
    trajectory = trajectory_of(result)
    found = threads(trajectory.events)
    assert [thread.lead for thread in found] == [1.25, 1.25]
    assert trajectory.feed[found[0].first : found[0].end].tolist() == pytest.approx([12.5, 6.25])
    assert finding(result, "depth of a thread off its turns")["value"] < 1e-4
    lines = result.program.read_text().splitlines()
    codes = [line for line in lines if re.fullmatch(r"S500 M3|M5|M2[89]|DWELL500", line)]
    assert codes == ["S500 M3", *["M29", "DWELL500", "M28"] * 2, "S500 M3", "M5"]


@pytest.mark.slow
@pytest.mark.parametrize(("sdac", "after"), [("4", ["S500 M4", "M5"]), ("5", ["M5"]), ("", ["S500 M3", "M5"])])
def test_the_spindle_turns_as_sdac_says(tmp_path, sdac, after):
    lines = siemens(tmp_path, sdac=sdac, lead="-1").program.read_text().splitlines()
    behind = lines[lines.index("M28") :]
    assert [line for line in behind if re.fullmatch(r"S500 M\d|M5", line)] == after


@pytest.mark.parametrize(
    ("before", "after", "code"),
    [
        (",1.25,0,600", ",1.25,90,600", "G602"),
        ("600,300)", "600,300,3,0,0,1)", "G602"),
        ("G71", "G70", "G602"),
        ("3,,1.25", "3,9,", "G418"),
        ("3,,1.25", "3,6,1.25", "G418"),
        ("3,,1.25", "3,,", "G418"),
        ("600,300)", "0,300)", "G418"),
        ("S500 M3", "M5", "G405"),
        ("CYCLE84", "CYCLE840", "G425"),
    ],
)
def test_cycle84_without_its_meaning_is_refused(tmp_path, before, after, code):
    text = SIEMENS.format(sdac="3", size="", lead="1.25")
    assert before in text
    assert refusal(tmp_path, text.replace(before, after), name="part.mpf")[0][0] == code


def test_cycle84_in_threads_per_inch_and_on_another_machine(tmp_path):
    text = SIEMENS.format(sdac="3", size="", lead="20").replace("600,300)", "600,300,3,2)")
    found = threads(trajectory_of(posted(tmp_path, text, name="part.mpf")).events)
    assert [thread.lead for thread in found] == [1.27, 1.27]
    shutil.rmtree(tmp_path / "out")
    none = spindle_axis_text(table="", codes="")
    assert refusal(tmp_path, text, machine=none, name="part.mpf")[0] == ("G425", 5)
