# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player: plays a trajectory on a controller while it is being planned, at any feed override.

``docs/numerical-control.md`` has the design. The way of the data: a trajectory in ``sections``; ``pieces`` with a stop
each, both ``legs`` that are certified against their ``subpath`` of the trajectory; the ``knot_list`` in the controller,
kept filled by ``list_feed``; ``play`` runs them all, with the ``stop_events`` between parts, and ``start_line`` begins
at a line.
"""

from pkm_post.control.player.orders import Order, OrderKind, PlayOptions, PlayState
from pkm_post.control.player.play import Player, PlayResult
from pkm_post.control.player.playable import first_row, read_playable
from pkm_post.control.player.window_play import WindowPlay

__all__ = [
    "Order",
    "OrderKind",
    "PlayOptions",
    "PlayResult",
    "PlayState",
    "Player",
    "WindowPlay",
    "first_row",
    "read_playable",
]
