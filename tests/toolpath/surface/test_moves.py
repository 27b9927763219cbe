# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program of a surface path: approach, leads, lifts, feeds, and where it cannot be made."""

import math

import numpy as np
import pytest
from shapes import BALL, PLACE, covered, cylinder, plate, settings, sphere, torus

from pkm_post.model import Kind
from pkm_post.toolpath.surface.moves import program_from_poses
from pkm_post.toolpath.surface.options import LeadMove, PassOrder
from pkm_post.toolpath.surface.tool_axis import AxisRule, clamp_to_cone
from pkm_post.toolpath.symmetry.cut_direction import material_side
from pkm_post.toolpath.symmetry.reverse import reversed_passes
from pkm_post.toolpath.symmetry.transform import mirror, transform

LEAN = AxisRule(lead=math.radians(10.0), tilt=math.radians(15.0))
UP = np.array([0.0, 0.0, 1.0])


def made(surface, **chosen):
    """The program, and the poses it was made from."""
    poses = covered(surface, BALL, **chosen)
    program, faults = program_from_poses([poses], settings(**chosen), PLACE)
    assert program is not None, faults
    return program, poses


def contacts(program):
    return np.flatnonzero(~np.isnan(program.normal[:, 0]))


def test_every_pose_is_a_row_with_its_normal():
    program, poses = made(plate(), rule=LEAN, order=PassOrder.ONE_WAY)
    rows = contacts(program)
    assert program.position[rows] == pytest.approx(poses.tip)
    assert program.tool_axis[rows] == pytest.approx(poses.axis)
    assert program.normal[rows] == pytest.approx(poses.normal)
    assert set(program.kind[rows]) == {Kind.LINE}
    plunges = np.flatnonzero(program.feed == 5.0)
    assert set(plunges) < set(rows)
    assert set(program.feed[np.setdiff1d(rows, plunges)]) == {20.0}


def test_first_and_last_move_are_at_clearance_and_the_others_at_safe_height():
    program, _ = made(plate(), rule=LEAN, order=PassOrder.ONE_WAY)
    heights = program.position[:, 2]
    assert (program.kind[0], heights[0], heights[-1]) == (Kind.RAPID, 80.0, pytest.approx(80.0))
    crossing = (program.kind == Kind.RAPID) & (np.abs(program.tool_axis - UP).max(axis=1) < 1e-12)
    assert heights[crossing][1:-1] == pytest.approx(60.0)
    # what goes from one place of the plane to another one goes upright
    apart = np.linalg.norm(np.diff(program.position[:, :2], axis=0), axis=1)
    level = (np.abs(heights[1:] - 60.0) < 1e-9) & (np.abs(heights[:-1] - 60.0) < 1e-9) & (apart > 1e-6)
    assert level.sum() == 20
    assert crossing[1:][level].all() and crossing[:-1][level].all()


def test_tool_comes_and_leaves_along_its_axis():
    program, _ = made(plate(), rule=LEAN, order=PassOrder.ONE_WAY, approach=3.0)
    rows = contacts(program)
    last = rows[np.flatnonzero(np.append(np.diff(rows) > 1, True))]
    way = program.position[last + 1] - program.position[last]
    assert np.abs(np.cross(way, program.tool_axis[last])).max() < 1e-9
    assert program.tool_axis[last + 1] == pytest.approx(program.tool_axis[last])
    plunges = np.flatnonzero((program.feed == 5.0) | (np.isnan(program.feed)))
    down = [row for row in plunges if program.kind[row] == Kind.LINE]
    way = program.position[down] - program.position[np.array(down) - 1]
    assert np.linalg.norm(way, axis=1) == pytest.approx(3.0)
    assert program.kind[np.array(down) - 1].tolist() == [Kind.RAPID] * 21


def test_straight_lead_runs_on_along_the_feed():
    program, poses = made(plate(), lead_move=LeadMove.TANGENT, lead_length=4.0)
    row = contacts(program)[-1]
    assert program.position[row + 1] - program.position[row] == pytest.approx(4.0 * poses.frame.feed[-1])
    first = contacts(program)[0]
    assert program.position[first] - program.position[first - 1] == pytest.approx(4.0 * poses.frame.feed[0])


def test_arc_leads_leave_the_surface_on_a_quarter_circle():
    program, poses = made(cylinder(), rule=AxisRule(tilt=0.5), lead_move=LeadMove.ARC, lead_length=5.0)
    first, last = contacts(program)[[0, -1]]
    for row, sense, pose in ((first, -1.0, 0), (last, 1.0, -1)):
        centre = poses.tip[pose] + 5.0 * poses.normal[pose]
        rows = np.flatnonzero(program.kind == Kind.LINE)
        rows = rows[rows >= row] if sense > 0 else rows[rows <= row]
        assert np.linalg.norm(program.position[rows] - centre, axis=1) == pytest.approx(5.0)
        end = rows[-1] if sense > 0 else rows[0]
        off = program.position[end] - poses.tip[pose]
        assert off == pytest.approx(5.0 * (poses.normal[pose] + sense * poses.frame.feed[pose]))
        assert len(rows) > 5


def test_cone_that_excludes_upright_rests_as_near_to_it_as_it_can():
    rule = AxisRule(cone_axis=(1.0, 0.0, 1.0), cone=math.radians(20.0), tilt=0.5)
    program, _ = made(plate(), rule=rule)
    expected, _ = clamp_to_cone(UP[None], np.array([1.0, 0.0, 1.0]), rule.cone)
    assert program.tool_axis[0] == pytest.approx(expected[0])
    assert math.degrees(math.acos(program.tool_axis[0, 2])) == pytest.approx(25.0)


def test_surfaces_follow_one_another_in_their_order():
    both = [covered(plate()), covered(plate(width=10.0))]
    program, _ = program_from_poses(both, settings(), PLACE)
    rows = contacts(program)
    assert len(rows) == sum(len(poses.tip) for poses in both)
    assert program.position[rows] == pytest.approx(np.vstack([poses.tip for poses in both]))


def refused(surface, rule=AxisRule(), **chosen):  # noqa: B008 - frozen
    poses = covered(surface, rule=rule)
    program, faults = program_from_poses([poses], settings(rule=rule, **chosen), PLACE)
    assert program is None
    return {fault.code for fault in faults}


def test_tool_that_cannot_be_lifted_is_reported():
    assert refused(cylinder()) == {"N304"}
    assert refused(plate(), safe_height=-1.0, clearance_height=-1.0) == {"N307"}


@pytest.mark.slow
@pytest.mark.parametrize("lean", [AxisRule(), LEAN], ids=["upright", "leaning"])
@pytest.mark.parametrize("order", [PassOrder.ONE_WAY, PassOrder.ZIGZAG])
@pytest.mark.parametrize(
    "surface", [plate(), sphere(), torus(lowest=0.6, highest=2.5)], ids=["plate", "sphere", "torus"]
)
def test_passes_can_be_reversed_with_a_plane_below_the_approach(surface, order, lean):
    """Rapid moves come down to 9 mm; the plane between the passes is nearer."""
    top = covered(surface, BALL, order=order, rule=lean).tip[:, 2].max()
    program, _ = made(surface, rule=lean, order=order, approach=9.0, safe_height=top + 1.0)
    image, _ = transform(program, mirror((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    back, faults = reversed_passes(image)
    assert back is not None, faults
    # the mirror image alone has the material on the other side of the cutter, the reversed passes where it was
    sides = [[int((material_side(each) == side).sum()) for side in (-1, 1)] for each in (program, back, image)]
    assert sides[0] == sides[1] == sides[2][::-1]
