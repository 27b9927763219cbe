# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collisions: what runs into the part, the stock or a fixture, of a trajectory on its machine.

``find_collisions`` takes a trajectory, a machine and what is known of the set-up; faults leave, and rows that say what
was checked against what, and what was not known.
"""

from pkm_post.collisions.check import Collisions, find_collisions, names_of, placed_part

__all__ = ["Collisions", "find_collisions", "names_of", "placed_part"]
