# SPDX-License-Identifier: LGPL-2.1-or-later
"""Defaults of the pmac commands: the command line shows them, even without NumPy."""

PARITIES = {"none": "N", "odd": "O", "even": "E"}
"""Parities of a serial line, with their names in pyserial."""
NEAR_MM = 0.05
"""Largest distance of each strut and of the tool tip to the start of a program: the following errors of standing
struts."""
OWN_PROGRAM = 999
"""Program number of a manual move; jobs use others."""
APPROACH_MM_S = 10.0
"""Tip speed of the planned approach to the start of a program; for a turn in place, degrees per second."""
