# SPDX-License-Identifier: LGPL-2.1-or-later
"""A posted program run line by line of its source, each to rest, as people see it."""

import dataclasses
import json

import numpy as np
import pytest
from station import MACHINE, SETTINGS, TOOL, new_station

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.program import read_job
from pkm_post.control.numerical_control.execute import target_deviation
from pkm_post.control.numerical_control.single_block import read_blocks
from pkm_post.model import Event, EventKind
from pkm_post.posting.post_file import post_file
from pkm_post.writing.controllers.pvt.writer import rest_knots

MICRON, COUNT = 1e-3, 1e-4
HOME = (0.0, 0.0, 300.0)
SOURCE = """\
G21 G90 G17 G54
S1000 M3
G0 X1 Y0 Z300
G1 X2 F1200
X2 Y1
G3 X1 Y2 R1
M8

( a comment )
G1 X0
X-1 Y1 (a corner)
M0
G1 X-1 Y0 Z301
X0
G81 X1 Y1 Z298 R300 L2 F1200
G80 G0 X0 Y0 Z302
M9 M5
M30
"""
ENDS = {
    3: (1, 0, 300), 4: (2, 0, 300), 5: (2, 1, 300), 6: (1, 2, 300), 10: (0, 2, 300), 11: (-1, 1, 300), 13: (-1, 0, 301),
    14: (0, 0, 301), 15: (1, 1, 301), 16: (0, 0, 302),
}  # fmt: skip
"""By line where it leads, in the work frame."""


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    """The folder of a posted program, with its source."""
    folder = tmp_path_factory.mktemp("posted")
    post(folder, SOURCE)
    return folder


def post(folder, source, *tools):
    (folder / "part.ngc").write_text(source)
    post_file(folder / "part.ngc", "example_6tps", folder, tool_lengths=dict.fromkeys(tools or (0,), TOOL))


def blocks_in(folder):
    blocks, reported = read_blocks(folder / "part.pmc", MACHINE)
    assert blocks is not None and not reported
    return blocks


def origin(blocks):
    return blocks.trajectory.machine_from_work[:3, 3]


def rests_in(folder):
    job, _ = read_job((folder / "part.pmc").read_text(), SETTINGS, "part.pmc")
    return len(rest_knots(job.motion, SETTINGS))


def test_the_posted_program_rests_seldom_and_has_a_block_for_each_line_that_moves(posted, tmp_path):
    without_cycle = "".join(line for line in SOURCE.splitlines(True) if not line.startswith("G81"))
    post(tmp_path, without_cycle.replace("G80 ", ""))
    assert rests_in(tmp_path) < len(ENDS) - 1  # without the line of the cycle
    assert rests_in(posted) == rests_in(tmp_path) + 6  # before it, over the hole, then twice at its bottom and above
    blocks = blocks_in(posted)
    lines = SOURCE.splitlines()
    shown = [blocks.shown(number) for number in range(1, len(blocks) + 1)]
    assert [each.line for each in shown] == list(ENDS)
    codes = {3: ("S1000 M3 | ", ""), 10: ("M8 | ", ""), 16: ("", " | M5 M9")}
    texts = [lines[line - 1].join(codes.get(line, ("", ""))) for line in ENDS]
    assert [each.text for each in shown] == texts
    assert str(shown[1]) == "block 2 of 10, line 4: G1 X2 F1200"
    assert blocks.shown(11).is_over and not blocks.shown(10).is_over


def test_the_blocks_are_the_way_of_the_program_without_its_stops(posted):
    blocks = blocks_in(posted)
    parts, whole = [blocks.block(number) for number in range(1, len(blocks) + 1)], blocks.trajectory
    assert np.array_equal(np.vstack([part.tip for part in parts]), whole.tip)
    assert all(part.exact_stop[-1] and not part.smooth[-1] for part in parts)
    for before, after in zip(parts[:-1], parts[1:], strict=True):
        assert np.array_equal(before.tip[-1], after.start_tip) and np.array_equal(before.axis[-1], after.start_axis)
    events = [(each.kind, each.value) for part in parts for each in part.events]
    assert events == [(each.kind, each.value) for each in whole.events if each.kind is not EventKind.STOP]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["tcp", "serial"])
def test_each_start_runs_one_line_and_rests_at_its_end(posted, kind):
    station, blocks = new_station(kind), blocks_in(posted)
    control, read = station.control, station.wire.controller.variables.read
    assert control.poll().block is None
    assert control.open_blocks(blocks) == len(ENDS)
    spindle, coolant = {}, {}
    for number, (line, end) in enumerate(ENDS.items(), 1):
        assert control.poll().block.line == line
        plan, reported = control.plan_step()
        assert not reported and plan.job.program.number == 999
        control.execute(plan)
        state = station.to_rest()
        assert not state.status.running and state.block.number == number + 1
        assert np.linalg.norm(state.pose.tip - origin(blocks) - end) < 5 * MICRON
        assert target_deviation(state.status, plan.lengths) < 2 * COUNT and state.status.fault_texts() == ()
        spindle[line], coolant[line] = read("P", 7001), read("P", 7002)
    assert spindle == dict.fromkeys(ENDS, 1) | {16: 0}  # M5 stands behind all that moves
    assert coolant == {line: int(10 <= line < 16) for line in ENDS}  # M8 stands behind line 6: with the next that moves
    assert control.poll().block.is_over
    with pytest.raises(ValueError, match="expected a block that comes next"):
        control.plan_step()


@pytest.mark.slow
def test_a_stopped_spindle_turns_again_where_a_block_is_begun(station, posted):
    control, blocks, variables = station.control, blocks_in(posted), station.wire.controller.variables
    control.open_blocks(blocks)
    control.execute(control.plan_step()[0])
    station.to_rest()
    variables.write("P", 7001, 0)
    control.open_blocks(blocks.begun_at(2, MACHINE)[0], at=2)
    control.execute(control.plan_step()[0])
    station.to_rest()
    assert variables.read("P", 7001) == 1


@pytest.mark.slow
def test_31_lines_that_blend_are_31_blocks(station, tmp_path):
    lines = [f"G1 X{x} Y{x % 2} Z300 F3000" for x in range(1, 32)]
    post(tmp_path, "G21 G90 G64 P0.5\n" + "\n".join(lines) + "\nM30\n")
    assert rests_in(tmp_path) == 2
    blocks = blocks_in(tmp_path)
    assert station.control.open_blocks(blocks) == 31
    for number in (1, 2):
        plan, _ = station.control.plan_step()
        station.control.execute(plan)
        state = station.to_rest()
        at = state.pose.tip - origin(blocks)
        assert np.allclose(at, (number, number % 2, 300), atol=5 * MICRON)
        assert state.block.text == lines[number]


def test_a_tool_change_ends_a_block(tmp_path):
    post(tmp_path, "G21 G90\nT1 M6\nG0 X1 Y0 Z300\nT2 M6 G0 X2\nG1 X3 F600\nM30\n", 1, 2)
    blocks = blocks_in(tmp_path)
    shown = [blocks.shown(number).line for number in range(1, len(blocks) + 1)]
    assert sorted(set(shown)) == [3, 4, 5]
    texts = [blocks.shown(number).text for number in range(1, len(blocks) + 1)]
    assert texts[0].startswith("T1 M6 | G0 X1") and any(text.startswith("T2 M6 | ") for text in texts)
    changes = [[each.value for each in blocks.block(number).events] for number in range(1, len(shown) + 1)]
    assert changes[0] == [1.0] and [2.0] in changes
    for number in range(1, len(shown) + 1):
        assert all(each.row == 0 for each in blocks.block(number).events)
        assert len(set(blocks.block(number).tool.tolist())) == 1


def test_spindle_and_coolant_of_the_blocks_before_are_switched_where_it_begins(tmp_path):
    source = """G21 G90
S1000 M3 M8
T1 M6
S2000 M3
G0 X1 Y0 Z300
G1 X2 F600
( a comment )
X3
S3000 M3
X4
M5
G0 X5
T2 M6
G0 X6
M30
"""
    post(tmp_path, source, 1, 2)
    whole = blocks_in(tmp_path)
    machine = dataclasses.replace(MACHINE, spin_up_time=MACHINE.spindle_speed / 1000)
    lines = [whole.shown(number).line for number in range(1, len(whole) + 1)]
    shown = {}
    for number, line in enumerate(lines, 1):
        blocks, found = whole.begun_at(number, machine)
        assert not found
        shown.setdefault(line, blocks.shown(number).text)
        assert [blocks.shown(each) for each in range(number + 1, len(lines) + 2)] == [
            whole.shown(each) for each in range(number + 1, len(lines) + 2)
        ]
    assert shown[5].count("S2000 M3") == 1
    assert shown[6] == "M8 S2000 M3 G4 P2 | G1 X2 F600"
    assert shown[8] == "M8 S2000 M3 G4 P2 | X3"
    assert shown[10] == "M8 S2000 M3 G4 P2 S3000 M3 | X4"
    assert shown[12] == "M8 M5 | G0 X5"
    assert "M3" not in shown[14] and "T2 M6" in shown[14]
    events = Event(0, EventKind.FUNCTION, 64.0), *whole.trajectory.events
    coded = dataclasses.replace(whole, trajectory=dataclasses.replace(whole.trajectory, events=events))
    assert coded.begun_at(1, machine) == (coded, ())
    found = coded.begun_at(3, machine)[1]
    assert [(each.code, each.found) for each in found] == [("K152", "M64")]


@pytest.mark.slow
def test_a_block_that_is_held_goes_on_and_the_next_one_waits(station, posted):
    control = station.control
    control.open_blocks(blocks_in(posted))
    plan, _ = control.plan_step()
    control.execute(plan)
    control.hold()
    assert control.poll().block.number == 2 and control.poll().status.held
    control.resume()
    assert target_deviation(station.to_rest().status, plan.lengths) < 2 * COUNT


def test_a_block_does_not_begin_elsewhere(station, posted):
    control = station.control
    control.open_blocks(blocks_in(posted), at=3)
    plan, _ = control.plan_step()
    with pytest.raises(NotReadyError, match="from the first point"):
        control.execute(plan)
    assert control.poll().block.number == 3  # it still comes next


@pytest.mark.parametrize("block", [0, 11])
def test_there_is_no_such_block(station, posted, block):
    blocks = blocks_in(posted)
    with pytest.raises(ValueError, match="expected a block from 1 to 10"):
        station.control.open_blocks(blocks, at=block)
    with pytest.raises(ValueError, match="expected a block from 1 to 10"):
        blocks.block(block)


def test_nothing_to_step_to(station):
    with pytest.raises(ValueError, match="expected a block that comes next, got none"):
        station.control.plan_step()


def test_a_source_that_is_not_the_one_that_was_posted_is_not_shown(tmp_path):
    post(tmp_path, SOURCE)
    (tmp_path / "part.ngc").write_text(SOURCE.replace("X2", "X3"))
    assert blocks_in(tmp_path).shown(2).text == "-> X2.000 Y0.000 Z300.000"
    (tmp_path / "part.ngc").unlink()
    assert str(blocks_in(tmp_path).shown(1)) == "block 1 of 10, line 3: S1000 M3 | -> X1.000 Y0.000 Z300.000"


def refused(folder, machine=MACHINE):
    blocks, reported = read_blocks(folder / "part.pmc", machine)
    assert blocks is None
    return [each.code for each in reported]


def test_a_program_whose_lines_are_not_known_is_refused_by_name(tmp_path):
    post(tmp_path, SOURCE)
    manifest = tmp_path / "part-manifest.json"
    text = manifest.read_text()
    manifest.unlink()
    assert refused(tmp_path) == ["C205"]
    content = json.loads(text)
    del content["files"]["part.pkmt"]
    manifest.write_text(json.dumps(content))
    assert refused(tmp_path) == ["C205"]
    manifest.write_text(text)
    (tmp_path / "part.pkmt").unlink()
    assert refused(tmp_path) == ["F106"]


def test_a_program_of_another_machine_is_refused(posted):
    import dataclasses

    assert refused(posted, dataclasses.replace(MACHINE, fingerprint="0" * 64)) == ["T104"]
