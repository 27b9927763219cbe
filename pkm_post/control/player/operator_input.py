# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operator input: where the operator's orders arrive, from any thread, and what they have come to.

Enters: orders. Leaves: the override, single block, and whether to go on or to end; holds and resumes go to the
controller at once.
"""

from __future__ import annotations

import queue

from pkm_post.control.link import run, stopping
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import AnySettings
from pkm_post.control.player.orders import Order, PlayOptions
from pkm_post.control.player.pieces import HIGHEST_OVERRIDE


class OperatorInput:
    """The operator's side of a player.

    Attributes:
        override: factor of the feed; 0 for a stop on the path.
        single_block: whether to rest at the end of each line.
        is_over: whether to end at the next stop on the path.
        may_start: whether a start was ordered since this was cleared.
        is_held_back: whether a hold found nothing that ran: nothing starts until it is resumed.
    """

    def __init__(self, choices: PlayOptions) -> None:
        self.override, self.single_block = choices.override, choices.single_block
        self.is_over = self.may_start = self.is_held_back = False
        self._orders: queue.SimpleQueue[Order] = queue.SimpleQueue()

    def order(self, order: Order) -> None:
        """Give an order, from any thread."""
        self._orders.put(order)

    def carry_out(self, session: Session, settings: AnySettings) -> None:
        """Carry out what was ordered.

        Raises:
            PmacError: a hold or a resume failed.
        """
        while not self._orders.empty():
            order = self._orders.get()
            if order.kind == "hold":
                self.is_held_back = not stopping.hold(session, settings).held
            elif order.kind == "resume" and self.is_held_back:
                self.is_held_back = False
            elif order.kind == "resume":
                run.resume_program(session, settings)
            else:
                self._note(order)

    def _note(self, order: Order) -> None:
        if order.kind == "override":
            self.override = min(max(order.value, 0.0), HIGHEST_OVERRIDE)
        elif order.kind == "single":
            self.single_block = bool(order.value)
        elif order.kind == "start":
            self.may_start = True
        elif order.kind == "end":
            self.is_over = True
        else:
            raise ValueError(f"kind: expected an order, got {order.kind!r}")
