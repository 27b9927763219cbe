# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calibration: from a measurement file and a machine file to a calibrated machine file."""
