# SPDX-License-Identifier: LGPL-2.1-or-later
"""Near: how near to the start of a program a machine has to stand. The command line shows it without NumPy."""

NEAR_MM = 0.05
"""How far each strut and the tool tip may be away, unless the user says otherwise: what following errors of standing
struts make."""
