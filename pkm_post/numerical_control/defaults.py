# SPDX-License-Identifier: LGPL-2.1-or-later
"""Defaults: values the user does not give. The command line shows them, even without NumPy."""

OWN_PROGRAM = 999
"""Program number of a manual move; jobs use others."""
APPROACH_MM_S = 10.0
"""Tip speed of the planned approach to the start of a program; for a turn in place, degrees per second."""
