# SPDX-License-Identifier: LGPL-2.1-or-later
"""A trajectory file that lies under right checksums, or contradicts itself, is refused by name and costs no memory."""

import dataclasses
import random
import tracemalloc

import numpy as np
import pytest
from lying_trajectories import is_refused_by_name, lie, posted, verified
from machines import example
from programs import ON_PALLET, cone
from series import cases

from pkm_post.cli import main
from pkm_post.machine import machine_named
from pkm_post.model import Event, EventKind, Refused
from pkm_post.posting.verify import verify
from pkm_post.toolpath.place import place
from pkm_post.writing.trajectory_file import decode, write, writer

SEEDS = cases(100)
TIMES_THE_SIZE = 12
"""What reading a file takes, by its size, beside what any file takes."""
BESIDE = 512 * 1024


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    program, trajectory = posted(tmp_path_factory.mktemp("lies"))
    return program, trajectory, trajectory.read_bytes()


@pytest.fixture(scope="module")
def trajectory(files):
    found, diagnostics = decode(files[2], "part.pkmt")
    assert diagnostics == ()
    return found


@pytest.mark.slow
def test_lies_are_refused_by_name_or_change_nothing_that_is_run(files):
    program, file, sound = files
    assert verified(program, file, sound)[0] == 0
    codes = []
    for seed in range(SEEDS):
        content, done = lie(random.Random(seed), sound)
        code, reported = verified(program, file, content)
        assert code == 0 or is_refused_by_name(code, reported), (seed, done, reported)
        codes.append(code)
    assert sum(codes) > SEEDS / 2


@pytest.mark.slow
def test_reading_a_lie_takes_no_more_memory_than_its_size_allows(files):
    decode(files[2], "part.pkmt")
    for seed in range(SEEDS):
        content, done = lie(random.Random(seed), files[2])
        tracemalloc.start()
        decode(content, "part.pkmt")
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < TIMES_THE_SIZE * len(content) + BESIDE, (seed, done)


def changed(trajectory, column, row, value):
    values = getattr(trajectory, column).copy()
    values[row] = value
    return dataclasses.replace(trajectory, **{column: values})


def with_event(trajectory, number, **values):
    events = list(trajectory.events)
    events[number] = dataclasses.replace(events[number], **values)
    return dataclasses.replace(trajectory, events=tuple(events))


def lies_of_content(trajectory):
    """What each contradiction is called, and a trajectory that has it."""
    change = next(at for at, event in enumerate(trajectory.events) if event.value == 2)
    row = trajectory.events[change].row
    corner = next(at for at in range(1, len(trajectory)) if not (trajectory.smooth | trajectory.exact_stop)[at])
    yield f"segment {row} has tool 2, the instructions change to tool 1", with_event(trajectory, change, value=1.0)
    yield f"takes place behind segment {row - 1}, which does not end", changed(trajectory, "exact_stop", row - 1, False)
    yield "the last segment does not end at rest", changed(trajectory, "exact_stop", -1, False)
    yield f"segment {row - 1} ends at rest and continues smoothly", changed(trajectory, "smooth", row - 1, True)
    yield f"segment {corner} continues smoothly, and a corner follows it", changed(trajectory, "smooth", corner, True)


def test_each_contradiction_is_named(trajectory, tmp_path, monkeypatch):
    file = tmp_path / "part.pkmt"
    for words, lying in lies_of_content(trajectory):
        with pytest.raises(ValueError, match=words):
            write(lying, file)
        assert not file.exists()
        with monkeypatch.context() as careless:
            careless.setattr(writer, "contradictions", lambda _: [])
            write(lying, file)
        _, diagnostics = decode(file.read_bytes(), "part.pkmt")
        assert {item.code for item in diagnostics} == {"T106"}
        assert any(words in item.found for item in diagnostics), diagnostics
        file.unlink()


def test_a_tool_may_be_changed_when_all_is_done(trajectory, tmp_path):
    extra = (*trajectory.events, Event(len(trajectory), EventKind.TOOL_CHANGE, 7.0))
    write(dataclasses.replace(trajectory, events=extra), tmp_path / "part.pkmt")
    assert decode((tmp_path / "part.pkmt").read_bytes(), "part.pkmt")[1] == ()


def begun_at(made, start):
    """The trajectory with another first point of the tip, and the length of the way from there."""
    length = np.append(np.linalg.norm(made.tip[0] - start), made.length[1:])
    return dataclasses.replace(made, start_tip=start, length=length)


BEYOND = {
    "the feed is ": lambda made: dataclasses.replace(made, feed=made.feed * 1e4),
    "the spindle turns at 1e+06 rpm": lambda made: with_event(
        made, next(at for at, event in enumerate(made.events) if event.kind is EventKind.SPINDLE), value=1e6
    ),
    "the start pose is not the home": lambda made: dataclasses.replace(made, start_spin=1e-3),
    "the start pose is not the home of": lambda made: begun_at(made, made.start_tip + [0, 0, 0.1]),
}


@pytest.mark.parametrize(("found", "change"), BEYOND.items(), ids=BEYOND)
def test_what_its_machine_cannot_do_is_not_planned(files, trajectory, tmp_path, found, change):
    write(change(trajectory), tmp_path / "part.pkmt")
    machine, _ = machine_named("example_6tps")
    with pytest.raises(Refused) as refused:
        verify(files[0], tmp_path / "part.pkmt", machine)
    reported = [item for item in refused.value.diagnostics if item.code == "T107"]
    assert any(item.found.startswith(found) for item in reported), refused.value


def test_a_motion_of_more_than_a_week_is_refused_before_it_is_planned(tmp_path, capsys):
    """Each move takes less than a day."""
    moves = "".join(f"X{(number % 2) * 50}\n" for number in range(12))
    (tmp_path / "slow.ngc").write_text(f"T1 M6\nG0 X0 Y0 Z60\nG1 F0.04\n{moves}M2\n", encoding="ascii")
    arguments = ["post", str(tmp_path / "slow.ngc"), "--tool-length", "1=120", "--out", str(tmp_path / "out")]
    assert main(arguments) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "error K145: the motion takes longer than can be planned: " in line
    assert "at most 604800 s" in line
    assert list((tmp_path / "out").iterdir()) == []


@pytest.mark.parametrize(("code", "column", "value"), [("K146", "tip_tolerance", 1e-10), ("K147", "spin", -1e7)])
def test_numbers_that_no_plan_has_digits_for_are_refused_with_their_place(code, column, value):
    values = np.zeros(8)
    values[5] = value
    found, diagnostics = place(dataclasses.replace(cone(8), **{column: values}), example(), ON_PALLET)
    assert found is None
    assert [(item.code, item.place.line) for item in diagnostics] == [(code, 6)]


def test_a_tolerance_of_the_program_that_is_too_small_is_refused_with_its_line(tmp_path, capsys):
    (tmp_path / "part.ngc").write_text("T1 M6\nG0 X0 Y0 Z60\nG64 P0.0000000001\nG1 X10 F600\nM2\n", encoding="ascii")
    arguments = ["post", str(tmp_path / "part.ngc"), "--tool-length", "1=120", "--out", str(tmp_path / "out")]
    assert main(arguments) == 1
    assert "line 4: error K146" in capsys.readouterr().err
