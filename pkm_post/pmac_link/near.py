# SPDX-License-Identifier: LGPL-2.1-or-later
"""Near: start tolerance, the largest distance to a program's start. The command line shows it without NumPy."""

NEAR_MM = 0.05
"""Largest distance of each strut and of the tool tip, unless the user sets another: the following errors of standing
struts."""
