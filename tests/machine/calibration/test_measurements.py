# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files of measurements are read, or every row that is wrong is reported with its line."""

import numpy as np
import pytest
from machines import random_poses

from pkm_post.machine.calibration.calibrate_file import COLUMNS, read_measurements
from pkm_post.machine.kinematics.inverse import platform_rotation

HEAD = ",".join(COLUMNS)
ROW = "1,2,800,0,0,1,30,120,801,802,803,804,805,806"


def read(tmp_path, text):
    path = tmp_path / "poses.csv"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_measurements(path)


def test_numbers_arrive_in_mm_and_rad(tmp_path):
    measured, faults = read(
        tmp_path, f"# by the tracker\n\n{HEAD}\n{ROW}\n\n# again\n{ROW.replace('1,2,', '3, 4 ,')}\n"
    )
    assert faults == ()
    assert measured.tip.tolist() == [[1, 2, 800], [3, 4, 800]]
    assert measured.axis.tolist() == [[0, 0, 1]] * 2
    assert measured.spin == pytest.approx([np.pi / 6] * 2)
    assert measured.tool_length.tolist() == [120] * 2
    assert measured.lengths.tolist() == [[801, 802, 803, 804, 805, 806]] * 2


def test_axes_of_four_decimals_are_made_units(tmp_path):
    measured, _ = read(tmp_path, f"{HEAD}\r\n{ROW.replace(',0,0,1,', ',0.2588,0,0.9659,')}\r\n")
    assert np.linalg.norm(measured.axis, axis=1) == pytest.approx([1.0], abs=1e-15)


@pytest.mark.parametrize(
    ("text", "line", "found"),
    [
        ("", 0, "expected a line x,y,z"),
        ("x,y\n1,2\n", 1, "expected the columns"),
        (f"\n{HEAD}\n", 2, "no pose"),
        (f"{HEAD}\n{ROW},1\n", 2, "expected 14 numbers, got 15"),
        (f"{HEAD}\n{ROW}\n{ROW[2:]}\n", 3, "expected 14 numbers, got 13"),
        (f"{HEAD}\n{ROW.replace('802', 'far')}\n", 2, "l2: expected a number, got 'far'"),
        (f"{HEAD}\n{ROW.replace('802', 'nan')}\n", 2, "l2: expected a number, got 'nan'"),
        (f'{HEAD}\n"{ROW}\n{ROW}\n', 2, "expected 14 numbers, got 1"),
        (f"{HEAD}\n{'1' * 200_000}\n", 0, "field larger"),
        (f"{HEAD}\n{ROW.replace('802', '1e7')}\n", 2, "l2: expected a number, got '1e7'"),
        (f"{HEAD}\n{ROW.replace('802', '-802')}\n", 2, "l2: expected a length above 0"),
        (f"{HEAD}\n{ROW.replace(',0,0,1,', ',0,0,2,')}\n", 2, "expected a vector of length 1, got 2.0000"),
        (f"{HEAD}\n{ROW.replace(',0,0,1,', ',0,0,-1,')}\n", 2, "one that points down"),
    ],
)
def test_a_wrong_row_is_reported_with_its_line(tmp_path, text, line, found):
    measured, (fault,) = read(tmp_path, text)
    assert measured is None
    assert (fault.code, fault.place.line) == ("M202", line)
    assert found in fault.found


def test_all_wrong_rows_are_reported(tmp_path):
    _, faults = read(tmp_path, f"{HEAD}\n1\n{ROW}\n2\n")
    assert [fault.place.line for fault in faults] == [2, 4]


@pytest.mark.parametrize("content", [None, b"\xff\xfe"])
def test_files_that_cannot_be_read_are_reported(tmp_path, content):
    _, (fault,) = read_measurements(tmp_path / "none.csv") if content is None else read(tmp_path, content)
    assert fault.code == "M201"


def test_spin_follows_from_a_matrix_as_the_document_says():
    _, axis, spin, _ = random_poses(np.random.default_rng(1), 200, tilt_deg=80.0)
    matrix = platform_rotation(axis, spin)
    found = np.arctan2(matrix[:, 1, 0] - matrix[:, 0, 1], matrix[:, 0, 0] + matrix[:, 1, 1])
    assert found == pytest.approx(spin, abs=1e-14)
