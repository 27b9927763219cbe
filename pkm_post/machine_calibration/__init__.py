# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calibration of a machine from the files of a user: measurements and a machine file enter, a machine file leaves."""

from pkm_post.machine_calibration.calibrated import calibrate_file
from pkm_post.machine_calibration.measurements import COLUMNS, read_measurements

__all__ = ["COLUMNS", "calibrate_file", "read_measurements"]
