# SPDX-License-Identifier: LGPL-2.1-or-later
"""Position: the position of the workpiece on the machine with the largest margins."""

from pkm_post.machine.position.best_position import FREEDOMS, Position, best_position
from pkm_post.machine.position.reach_map import ReachMap, reach_map

__all__ = ["FREEDOMS", "Position", "ReachMap", "best_position", "reach_map"]
