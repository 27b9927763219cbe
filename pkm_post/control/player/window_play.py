# SPDX-License-Identifier: LGPL-2.1-or-later
"""Window play: a trajectory played by the worker of a connection, since the GUI must not block.

Meanwhile the worker reads nothing else; its state is the one read by the player. Stops ordered from the worker come
first; after a hold the play continues. Closing the worker ends the play, and the machine stops on the path.

Input: a connection, a trajectory, orders from the GUI thread. Output: the newest state, notes, and a result.
"""

from __future__ import annotations

import logging
import queue
from concurrent.futures import Future

from pkm_post.control.numerical_control.connection import Connection
from pkm_post.control.player.orders import HELD_BACK, Order, PlayOptions, PlayState
from pkm_post.control.player.play import Callbacks, Player, PlayResult
from pkm_post.model import Tolerances, Trajectory

_log = logging.getLogger(__package__)
"""All modules of the player log below this one."""


class _Notes(logging.Handler):
    def __init__(self, notes: queue.SimpleQueue[logging.LogRecord]) -> None:
        super().__init__()
        self._notes = notes

    def emit(self, record: logging.LogRecord) -> None:
        """Called by the logger, in the worker's thread."""
        self._notes.put(record)


class WindowPlay:
    """One play.

    Attributes:
        state: the newest state; None before the first one.
        notes: messages of the player, such as an impossible retract.
        done: the result, or the exception that ended it.
    """

    def __init__(
        self, connection: Connection, trajectory: Trajectory, tolerances: Tolerances, choices: PlayOptions
    ) -> None:
        """Queue the play; return at once.

        Args:
            connection: to a Turbo PMAC.
        """
        worker, target = connection.worker, connection.target
        self.state: PlayState | None = None
        self.notes: queue.SimpleQueue[logging.LogRecord] = queue.SimpleQueue()
        callbacks = Callbacks(self._show, worker.see, worker.lose, worker.give_way)
        self._player = Player(
            connection.session, target.machine, target.settings, trajectory, tolerances, choices, callbacks
        )
        self.done: Future[PlayResult] = worker.submit(lambda _control: self._played())

    @property
    def waits_for(self) -> str:
        """The reason why it waits for the operator; empty if it does not."""
        return "" if self.state is None else self.state.waits_for

    @property
    def is_held_back(self) -> bool:
        """Whether it waits for a resume, since a hold came when nothing ran."""
        return self.waits_for == HELD_BACK

    def order(self, order: Order) -> None:
        """Give an order; return at once."""
        self._player.order(order)

    def _played(self) -> PlayResult:
        """Play, and collect the notes of the player; called in the worker's thread."""
        handler = _Notes(self.notes)
        _log.setLevel(logging.INFO)
        _log.addHandler(handler)
        try:
            return self._player.play()
        finally:
            _log.removeHandler(handler)

    def _show(self, state: PlayState) -> None:
        """Called in the worker's thread."""
        self.state = state
