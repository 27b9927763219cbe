# SPDX-License-Identifier: LGPL-2.1-or-later
"""Defaults: what is taken where the user says nothing. The command line shows them, also where there is no NumPy."""

OWN_PROGRAM = 999
"""Number of the program of a move by hand; jobs have others."""
NEAR_MM = 0.05
"""How far a strut may be from where the move was planned from: what following errors of standing struts make."""
