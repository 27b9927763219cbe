# SPDX-License-Identifier: LGPL-2.1-or-later
"""Placement: where the program stands, by symmetry of the part (T_C) and by the work offset on the machine (D)."""

from pkm_post.placement.joined import joined
from pkm_post.placement.place import place
from pkm_post.placement.symmetry import mirror, mirrors, rotation, transform

__all__ = ["joined", "mirror", "mirrors", "place", "rotation", "transform"]
