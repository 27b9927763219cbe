# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine calibration: from a measurement file and a machine file to a calibrated machine file."""

from pkm_post.machine.calibration.calibrated import calibrate_file
from pkm_post.machine.calibration.measurements import COLUMNS, read_measurements

__all__ = ["COLUMNS", "calibrate_file", "read_measurements"]
