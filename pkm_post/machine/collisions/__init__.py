# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collisions: collisions of the machine and its tools with workpiece, stock and fixtures along a trajectory.

``find_collisions`` takes a trajectory, a machine and the known set-up; it returns faults, and coverage rows that state
what was checked against what, and what was unknown.
"""

from pkm_post.machine.collisions.check import Collisions, find_collisions, names_of, placed_part

__all__ = ["Collisions", "find_collisions", "names_of", "placed_part"]
