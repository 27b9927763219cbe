# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player: plays a trajectory on a controller while it is being planned, at any feed override.

``docs/numerical-control.md`` has the design. The data flows from a trajectory, in ``sections``, to ``pieces`` of
motion, each with a stop. Both are a ``certified_motion``, compared with its subpath of the trajectory.
``list_feed`` fills the ``knot_list`` in the controller. ``play`` runs them all, with the ``stop_events`` between parts;
``start_line`` begins at a line.
"""

from pkm_post.control.player.approach_check import approach_faults, check_start
from pkm_post.control.player.orders import Order, OrderKind, PlayOptions, PlayState
from pkm_post.control.player.play import Callbacks, Player, PlayResult
from pkm_post.control.player.playable import collisions_at_offsets, first_row, read_playable
from pkm_post.control.player.stop_events import PlayContext
from pkm_post.control.player.window_play import WindowPlay
