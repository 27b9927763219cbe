# SPDX-License-Identifier: LGPL-2.1-or-later
"""The approach to a row against a stock that the rows before have cut, and against clamps."""

from dataclasses import replace

import numpy as np
import pytest
from meshes import box
from playing import HOOK, MACHINE, Playing, trajectory_of

from pkm_post.control.numerical_control.manual_moves import approach_trajectory
from pkm_post.control.player.approach_check import approach_faults
from pkm_post.control.player.orders import Order
from pkm_post.control.player.stop_events import PlayContext, pose_before
from pkm_post.model import Kind, Mesh, Refused, Setup, Shank
from pkm_post.toolpath import ToolPose

STOCK = Mesh("stock.stl", box([-10, -10, 60], [40, 30, 95]))
"""The hook of the tests is cut 5 mm deep into it, by a ball of 12 mm."""
CUT = [Kind.RAPID, Kind.LINE, Kind.RAPID]
ABOVE_MM = 25.0


def codes(trajectory, row, setup, shift=(0.0, 0.0, 0.0)):
    """Codes of the approach to a row from a place beside the end of the row before it."""
    start, length = pose_before(trajectory, row)
    here = ToolPose(start.tip + shift, start.axis, start.spin)
    free = float(trajectory.tip[:, 2].max()) + ABOVE_MM
    approach, faults = approach_trajectory(MACHINE, here, start, length, 10.0, free)
    assert not faults
    return {each.code for each in approach_faults(PlayContext(None, MACHINE, None, trajectory, setup), row, approach)}


def test_nothing_is_known():
    assert codes(trajectory_of(), 2, Setup(), (-5, 0, 0)) == set()


def test_what_the_rows_before_have_cut_is_free():
    assert codes(trajectory_of(kind=CUT), 2, Setup(stock=STOCK), (-5, 0, 0)) == set()
    assert codes(trajectory_of(), 1, Setup(stock=STOCK), (0, 0, 40)) == set()  # it cuts on its way down, as row 1 does


@pytest.mark.parametrize("top, found", [(100.0, set()), (130.0, {"K136"})])
def test_stock_that_is_left_on_the_way_across(top, found):
    wall = Mesh("stock.stl", np.concatenate([STOCK.triangles, box([-10, 50, 60], [40, 60, top])]))
    assert codes(trajectory_of(), 2, Setup(stock=wall), (-12.0, 90.0, 0.0)) >= found
    assert bool(codes(trajectory_of(), 2, Setup(stock=wall), (-12.0, 90.0, 0.0))) == bool(found)


@pytest.mark.parametrize("top, found", [(100.0, set()), (125.0, {"K133"})])
def test_a_clamp_on_the_way_across(top, found):
    clamp = Mesh("clamp.stl", box([5, 40, 0], [20, 60, top]))
    assert codes(trajectory_of(), 2, Setup(fixtures=(clamp,)), (-12.0, 90.0, 0.0)) >= found
    assert bool(codes(trajectory_of(), 2, Setup(fixtures=(clamp,)), (-12.0, 90.0, 0.0))) == bool(found)


def test_what_the_program_hits_before_the_line_is_no_fault_of_the_approach_even_if_it_has_one_of_its_own():
    clamp, way = Mesh("clamp.stl", box([5, -5, 60], [10, 5, 95])), trajectory_of()
    named = replace(way, operations=("approach",) * len(way.operations))
    assert codes(way, 2, Setup(fixtures=(clamp,)), (-12.0, 90.0, 0.0)) == set()
    assert codes(named, 2, Setup(fixtures=(clamp,)), (-12.0, 90.0, 0.0)) == set()


SLOT = np.concatenate([box([0, -20, 60], [40, -4, 95]), box([0, 4, 60], [40, 20, 95])])
"""A slot of 8 mm, into which a ball of 12 mm with a thin shank goes from its end, 15 mm below the top."""
T_SLOT = trajectory_of(
    [[60, 0, 120], [60, 0, 80], [20, 0, 80], [30, 0, 80]], kind=[Kind.RAPID, Kind.RAPID, Kind.LINE, Kind.LINE]
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("row", "shift"), [(3, (40, 0, 60)), (3, (0, 0, 20)), (3, (0, 0, 65)), (2, (-30, 0, 0)), (2, (-5, 0, 0))]
)
def test_the_way_neither_cuts_down_into_a_slot_nor_up_out_of_it_through_the_part(row, shift):
    shanks = {tool: Shank(12.0, 6.0) for tool in T_SLOT.tools}
    into, stock, part = row == 3, Mesh("stock.stl", SLOT), Mesh("part.stl", SLOT)
    assert codes(T_SLOT, row, Setup(stock=stock, shanks=shanks), shift) == ({"K136"} if into else set())
    assert codes(T_SLOT, row, Setup(part=part, shanks=shanks), shift) == ({"K131"} if into or shift[0] < -20 else set())


@pytest.mark.slow
def test_a_play_whose_way_is_not_free_does_not_begin():
    clamp = Mesh("clamp.stl", box([20, -5, 60], [30, 5, 200]))
    playing = Playing.of(trajectory_of(HOOK), at={})
    with pytest.raises(Refused, match="K133"):
        playing.play(first_row=2, setup=Setup(fixtures=(clamp,)))
    assert np.ptp(playing.struts(), axis=0).max() < 1e-6
    playing = Playing.of(trajectory_of(HOOK), at={1: [Order("start")]})
    assert playing.play(first_row=2, setup=Setup(stock=STOCK)).finished and playing.arrived() < 1e-3
