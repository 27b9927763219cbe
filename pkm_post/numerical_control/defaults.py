# SPDX-License-Identifier: LGPL-2.1-or-later
"""Defaults: what is taken where the user says nothing. The command line shows them, also where there is no NumPy."""

OWN_PROGRAM = 999
"""Number of the program of a move by hand; jobs have others."""
APPROACH_MM_S = 10.0
"""Speed of the tip on the planned way to the start of a program, of a turn in place in degrees per second."""
