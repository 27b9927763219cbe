# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operator input: collects the operator's orders, from any thread, and applies them.

Input: orders. Output: the override, single block, stops at M1, and whether to continue or end; holds and resumes go to
the controller at once.
"""

from __future__ import annotations

import logging
import queue

from pkm_post.control.link import run, stopping
from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.owner_record import read_record, release_hold
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import AnySettings
from pkm_post.control.player.orders import Order, PlayOptions
from pkm_post.control.player.pieces import HIGHEST_OVERRIDE

LOWEST_OVERRIDE = 0.01
"""Least override above 0: a slower motion is planned no faster than it runs."""
_log = logging.getLogger(__name__)


class OperatorInput:
    """The operator's side of a player.

    Attributes:
        single_block: whether to rest at the end of each line.
        optional_stop: whether M1 stops.
        block_skip: whether the next ``/`` blocks are skipped.
        retract_mm: retract along the tool axis while the player waits, mm; 0 for none.
        is_over: whether to end at the next stop on the path.
        may_start: whether a start was ordered since this was cleared.
        is_held_back: whether a hold is a planned stop, or came when nothing ran: nothing starts until a resume.
        is_held_elsewhere: whether another client holds the play between two motions: only a resume continues it.
        holds_move: whether a hold of this operator stands in a move by hand.
    """

    def __init__(self, choices: PlayOptions, holds_on_path: bool = False) -> None:
        """Prepare.

        Args:
            choices: initial settings.
            holds_on_path: whether a hold is a planned stop; by default it is a feed hold of the controller.
        """
        self._asked, self._holds_on_path = _within(choices.override), holds_on_path
        self.single_block = choices.single_block
        self.optional_stop = choices.optional_stop
        self.block_skip, self.retract_mm = choices.block_skip, 0.0
        self.is_over = self.may_start = self.is_held_back = self.is_held_elsewhere = self.holds_move = False
        self._orders: queue.SimpleQueue[Order] = queue.SimpleQueue()

    @property
    def override(self) -> float:
        """Factor of the feed; 0 for a stop on the path."""
        return 0.0 if self._holds_on_path and self.is_held_back else self._asked

    def order(self, order: Order) -> None:
        """Give an order, from any thread."""
        self._orders.put(order)

    def look_elsewhere(self, session: Session) -> None:
        """Between two motions: whether another client holds the play there, or has resumed it.

        Raises:
            PmacError: the link failed.
        """
        before, self.is_held_elsewhere = self.is_held_elsewhere, read_record(session).is_held
        if before or self.is_held_elsewhere:
            self.is_held_back = self.is_held_elsewhere
        if self.is_held_elsewhere:
            self.may_start, self.retract_mm = False, 0.0

    def carry_out(self, session: Session, settings: AnySettings, by_hand: bool = False) -> None:
        """Execute the orders; a resume of what is not held, or has a fault, is refused with a warning.

        Args:
            by_hand: whether an approach, a retract or codes run, for which no stop is planned.

        Raises:
            PmacError: a hold failed, or the link during a resume.
        """
        while not self._orders.empty():
            order = self._orders.get()
            if order.kind == "hold" and self._holds_on_path and not by_hand:
                self.is_held_back = True
            elif order.kind == "hold":
                held = stopping.hold(session, settings).held
                self.is_held_back, self.holds_move = not held, held and by_hand
                if self.holds_move:  # no state of the play is shown meanwhile
                    _log.warning("held: resume continues, end ends the play")
            elif order.kind == "resume" and self.is_held_back:
                release_hold(session)
                self.is_held_back = self.is_held_elsewhere = False
            elif order.kind == "resume":
                self._resume(session, settings)
                self.holds_move = False
            else:
                self._note(order)

    @staticmethod
    def _resume(session: Session, settings: AnySettings) -> None:
        try:
            run.resume_program(session, settings)
        except NotReadyError as refused:
            _log.warning("%s", refused)

    def _note(self, order: Order) -> None:
        if order.kind == "override":
            self._asked = _within(order.value)
        elif order.kind == "single":
            self.single_block = bool(order.value)
        elif order.kind == "optional":
            self.optional_stop = bool(order.value)
        elif order.kind == "skip":
            self.block_skip = bool(order.value)
        elif order.kind == "retract":
            self.retract_mm = max(order.value, 0.0)
        elif order.kind == "start":
            self.may_start = True
        elif order.kind == "end":
            self.is_over = True
        else:
            raise ValueError(f"kind: expected an order, got {order.kind!r}")


def _within(override: float) -> float:
    """An override that can be planned: 0, or from the lowest to the highest one."""
    return min(max(override, LOWEST_OVERRIDE), HIGHEST_OVERRIDE) if override > 0 else 0.0
