# SPDX-License-Identifier: LGPL-2.1-or-later
"""A program run from rest to rest."""

import numpy as np
import pytest
from station import PER_BLOCK, job

from pkm_post.controllers.pvt.parts import joined
from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.numerical_control.execute import off_target
from pkm_post.numerical_control.single_block import blocks_of, same
from pkm_post.pmac_link.faults import NotReadyError

COUNT = 1e-4
"""mm: what the encoder of the example counts."""
EVENTS = (
    Event(0, EventKind.SPINDLE, 1200.0),
    Event(PER_BLOCK, EventKind.STOP, 0.0),
    Event(2 * PER_BLOCK, EventKind.COOLANT, 1.0),
    Event(3 * PER_BLOCK, EventKind.SPINDLE, 0.0),
)


def test_the_blocks_together_are_the_program_without_its_stops(station):
    made = job(station.settings, EVENTS)
    blocks = blocks_of(made, station.settings)
    assert len(blocks) == 3
    motions = [blocks.job(number).motion for number in (1, 2, 3)]
    whole, faults = joined(motions, ["1", "2", "3"])
    assert not faults
    assert whole.events == tuple(event for event in made.motion.events if event.kind is not EventKind.STOP)
    for name in ("time_ms", "length", "speed"):
        assert np.array_equal(getattr(whole, name), getattr(made.motion, name))
    assert {blocks.job(number).program.number for number in (1, 2, 3)} == {999}


def test_a_block_is_another_motion_when_a_number_differs(station):
    motion = blocks_of(job(station.settings, ()), station.settings).motions[0]
    length = motion.length.copy()
    length[3, 3] += 1e-6
    assert same(motion, motion) and not same(motion, StrutMotion(motion.time_ms, length, motion.speed, ()))


def test_it_runs_block_by_block(station):
    made, control = job(station.settings, EVENTS), station.control
    assert control.poll().block is None
    assert control.open_blocks(made) == 3 and control.poll().block == (1, 3)
    spindle, coolant = [], []
    for number in (1, 2, 3):
        last = control.step()
        state = station.to_rest()
        assert np.allclose(last, made.motion.length[number * PER_BLOCK]) and state.block == (number + 1, 3)
        assert off_target(state.status, last) < 2 * COUNT and state.status.words() == ()
        read = station.wire.controller.variables.read
        spindle.append(read("P", 7001))
        coolant.append(read("P", 7002))
    assert spindle == [1, 1, 0] and coolant == [0, 0, 1]
    with pytest.raises(ValueError, match="expected a block that comes next"):
        control.step()


def test_a_block_does_not_begin_elsewhere(station):
    control = station.control
    control.open_blocks(job(station.settings, EVENTS), at=2)
    with pytest.raises(NotReadyError, match="from the first point"):
        control.step()
    assert control.poll().block == (2, 3)  # it still comes next


@pytest.mark.parametrize("block", [0, 4])
def test_there_is_no_such_block(station, block):
    made = job(station.settings, EVENTS)
    with pytest.raises(ValueError, match="expected a block from 1 to 3"):
        station.control.open_blocks(made, at=block)
    with pytest.raises(ValueError, match="expected a block from 1 to 3"):
        blocks_of(made, station.settings).job(block)


def test_the_number_of_the_jobs_is_not_taken(station):
    with pytest.raises(ValueError, match="expected another one than that of the jobs"):
        blocks_of(job(station.settings, ()), station.settings, station.settings.program)


def test_nothing_to_step_to(station):
    with pytest.raises(ValueError, match="expected a block that comes next, got none"):
        station.control.step()
