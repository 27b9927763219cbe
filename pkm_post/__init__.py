# SPDX-License-Identifier: LGPL-2.1-or-later
"""PKM Post: from CAM jobs to certified motion of 6-TPS parallel kinematic machine tools."""

__version__ = "0.1.0"
