# SPDX-License-Identifier: LGPL-2.1-or-later
"""Removal: the stock left by the tools at any time of a motion, and its difference from the part."""

from pkm_post.removal.comparison import Comparison, compare, part_distances
from pkm_post.removal.replay import CutterPath, Replay, cutting_times
from pkm_post.removal.rotating_shape import RotatingShape
from pkm_post.removal.stock import Stock
from pkm_post.removal.surface import BrickSurface, brick_surfaces
