# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coverage against counting at many angles, and the paper's quadrants."""

import numpy as np
import pytest
from programs import cone, program, square_with_arc

from pkm_post.model import Kind
from pkm_post.toolpath.symmetry.coverage import Sector, coverage, mirror_gap, seam, seams, sector
from pkm_post.toolpath.symmetry.transform import mirror, rotation, transform

EXACT = 1e-9
QUARTER = np.pi / 2
Z = ([0, 0, 0], [0, 0, 1])
XZ, YZ = mirror([0, 0, 0], [0, 1, 0]), mirror([0, 0, 0], [1, 0, 0])


def copies(made, *matrices):
    return [made, *(transform(made, matrix)[0] for matrix in matrices)]


def turns(*degrees):
    return [rotation(*Z, np.radians(angle)) for angle in degrees]


def covered_by(programs):
    return coverage([sector(each, *Z) for each in programs])


def test_the_sector_of_a_quarter():
    found = sector(cone(40, turns=0.25), *Z)
    assert (found.width, found.spacing) == pytest.approx((QUARTER, 0), abs=EXACT)


@pytest.mark.parametrize("degrees", [0, 30, 170, 300, 359])
@pytest.mark.parametrize("axis", [[0, 0, 1], [1, 2, 3]])
def test_the_sector_turns_with_the_program(degrees, axis):
    point = [3, -4, 5]
    made = cone(40, turns=0.3)
    before = sector(made, point, axis)
    after = sector(copies(made, rotation(point, axis, np.radians(degrees)))[1], point, axis)
    assert (after.width, after.spacing) == pytest.approx((before.width, before.spacing), abs=EXACT)
    off = (after.start - before.start - np.radians(degrees) + np.pi) % (2 * np.pi) - np.pi
    assert off == pytest.approx(0, abs=EXACT)


def test_mirrored_quarters_of_the_paper_tile_the_column():
    found = covered_by(copies(cone(40, turns=0.25), XZ, YZ, *turns(180)))
    assert found.tiles
    assert (found.covered, found.overlap, found.gap) == pytest.approx((2 * np.pi, 0, 0), abs=EXACT)


def test_a_quarter_turn_in_place_of_the_half_turn_leaves_the_third_quarter_out():
    # The paper prints 90 degrees: its copy lies on that of the y-z mirror.
    found = covered_by(copies(cone(40, turns=0.25), XZ, YZ, *turns(90)))
    assert not found.tiles
    assert (found.covered, found.overlap, found.gap) == pytest.approx((3 * QUARTER, QUARTER, QUARTER), abs=EXACT)


@pytest.mark.parametrize("seed", range(10))
def test_coverage_is_what_counting_at_many_angles_finds(seed):
    rng = np.random.default_rng(seed)
    sectors = [Sector(*rng.uniform([0, 0.1], [2 * np.pi, 1.5]), 0.0) for _ in range(rng.integers(1, 6))]
    angles = (np.arange(200_000) + 0.5) * 2 * np.pi / 200_000
    times = sum(((angles - each.start) % (2 * np.pi) < each.width).astype(int) for each in sectors)
    found, step = coverage(sectors), 2 * np.pi / 200_000
    used = np.flatnonzero(times)
    widest = (np.diff(np.append(used, used[0] + len(times))).max() - 1) * step
    one_step_each = 4 * len(sectors) * step
    assert found.covered == pytest.approx(np.sum(times >= 1) * step, abs=one_step_each)
    assert found.overlap == pytest.approx(np.sum(times >= 2) * step, abs=one_step_each)
    assert found.gap == pytest.approx(widest, abs=one_step_each)


def test_passes_up_the_wall_may_stand_as_far_apart_as_within_a_copy():
    """Four lines up a cylinder, 20 degrees apart: the next copy begins 20 degrees further as well."""
    rows = []
    for angle in np.radians([5, 25, 45, 65]):
        x, y = 30 * np.cos(angle), 30 * np.sin(angle)
        rows += [(x, y, 60, Kind.RAPID), (x, y, 0, Kind.LINE), (x * 0.99, y * 0.99, 40, Kind.LINE)]
    table = np.array(rows)
    made = program(table[:, :3], kind=table[:, 3].astype(int))
    # Counted by hand: 4 lines span 60 degrees; 4 copies at 80 degrees leave 20 + 20 + 20 and 60 degrees.
    found = covered_by(copies(made, *turns(80, 160, 240)))
    assert np.degrees([found.spacing, found.overlap, found.gap]) == pytest.approx([20, 0, 60], abs=1e-6)
    assert not found.tiles
    assert covered_by(copies(made, *turns(80, 160, 240, 300))).overlap == pytest.approx(0, abs=EXACT)


def test_a_full_turn_covers_all_and_a_program_without_a_cut_has_no_sector():
    assert sector(cone(100), *Z).width == pytest.approx(2 * np.pi)
    assert sector(program([[10, 0, 50], [10, 0, 0]]), *Z) is None


def test_arcs_count_with_all_their_points():
    """The half circle about (30, 10) is seen from z under more than its ends are; found by sampling it finely."""
    made = square_with_arc()
    centre = [10, 10, 0]
    angle = np.linspace(-np.pi / 2, np.pi / 2, 100_001)
    x, y = 30 + 10 * np.cos(angle) - 10, 10 * np.sin(angle)
    rows = np.r_[2:4]
    part = program(made.position[rows], kind=made.kind[rows], centre=made.arc_centre[rows], turn=made.arc_axis[rows])
    found = sector(part, centre, [0, 0, 1])
    assert found.width == pytest.approx(np.ptp(np.arctan2(y, x)), abs=1e-3)


def test_a_line_through_the_axis_is_at_two_angles():
    found = sector(program([[-10, 0, 0], [10, 0, 0]]), *Z)
    assert (found.width, found.spacing) == pytest.approx((np.pi, np.pi))


@pytest.mark.parametrize(("offset", "found"), [(0, (0, 0)), (3, (6, 0)), (-4, (0, 8)), (-60, (0, 20)), (-80, (20, 0))])
def test_a_program_beside_its_mirror_image(offset, found):
    made = program([[offset, 0, 0], [offset + 70, 5, 0]])
    assert mirror_gap(made, [0, 0, 0], [2, 0, 0]) == pytest.approx(found)


def test_quarters_meet_with_their_axes_where_these_lie_in_the_planes_of_symmetry():
    made = cone(40, turns=0.25)
    level = program(made.position * [1, 1, 0], made.tool_axis)
    all_round = copies(level, XZ, YZ, *turns(180))
    found = seams(all_round, [sector(each, *Z) for each in all_round])
    assert len(found) == 4
    assert [(each.distance, each.turn) for each in found] == [pytest.approx((0, 0), abs=EXACT)] * 4


def test_a_lean_along_the_way_turns_over_at_the_joint():
    made = cone(40, turns=0.25)
    lean = np.radians(5)
    axis = made.tool_axis + 0.0
    axis[0] = [0, np.sin(lean), np.cos(lean)]  # the mirror makes -5 degrees of it
    both = copies(program(made.position * [1, 1, 0], axis), XZ)
    (found,) = seams(both, [sector(each, *Z) for each in both])
    assert (found.distance, found.turn) == pytest.approx((0, 2 * lean), abs=EXACT)


def test_copies_that_do_not_meet_have_no_joint():
    both = copies(cone(40, turns=0.25), *turns(180))
    assert seams(both, [sector(each, *Z) for each in both]) == ()


@pytest.mark.parametrize("offset", [0.0, 2.5])
def test_the_joint_at_a_mirror_is_twice_as_wide_as_the_distance_to_it(offset):
    one, other = copies(program([[offset, 0, 0], [30, 40, 0]]), YZ)
    found = seam(one, other)
    assert (found.distance, found.turn) == pytest.approx((2 * offset, 0), abs=EXACT)


def test_the_worst_of_all_passes_counts():
    rows = [[1, 0, 50], [1, 0, 0], [30, 0, 0], [30, 0, 50], [4, 9, 50], [4, 9, 0], [30, 9, 0]]
    one, other = copies(program(rows, kind=[0, 1, 1, 0, 0, 1, 1]), YZ)
    assert seam(one, other).distance == pytest.approx(8)


def test_programs_with_different_passes_are_no_copies():
    with pytest.raises(ValueError, match="1 and 0 passes"):
        seam(program([[0, 0, 0], [9, 0, 0]]), program([[0, 0, 0]]))
