# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points sorted into cells: every row once, and near ones together."""

import numpy as np
import pytest

from pkm_post.geometry.cells import cells


@pytest.mark.parametrize("about", [1, 7, 200, 5000])
def test_every_row_is_in_one_cell_and_cells_are_small(about):
    rng = np.random.default_rng(1)
    points = np.column_stack([rng.uniform(0, 100, (3000, 2)), rng.normal(0, 1, 3000)])
    found = cells(points, about)
    assert np.array_equal(np.sort(np.concatenate(found)), np.arange(3000))
    assert all(np.all(np.diff(rows) > 0) for rows in found)
    side = 100 / max(1, round(np.sqrt(3000 / about)))
    assert all(np.all(np.ptp(points[rows], axis=0) <= side * 1.001) for rows in found)
    assert about / 4 < np.mean([len(rows) for rows in found]) <= max(4 * about, 1)


def test_no_points_and_points_in_one_place():
    assert cells(np.zeros((0, 3)), 10) == []
    assert [rows.tolist() for rows in cells(np.ones((40, 3)), 10)] == [list(range(40))]
