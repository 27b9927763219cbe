# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dialogue: a link, a conversation and a clock together. One command goes out, one event comes back, within a time.

Enters: commands. Leaves: the event that ended each; what the link raises passes through.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from pkm_post.pmac_link.exchange import Answer, Command, Kind, Lost, Message, Refusal
from pkm_post.pmac_link.faults import CancelledError, LinkLostError, RefusedError
from pkm_post.pmac_link.ports import Door

LONG_S = 0.5
"""A query that takes longer may be left for what is more urgent; to connect anew takes about as long."""

Ending = Answer | Refusal | Lost


class Dialogue:
    """Commands one after the other.

    Attributes:
        messages: what programs in the controller sent of their own accord.
        patience: seconds without a byte until an answer is given up.
        gives_way: asked while a query takes long: whether something more urgent waits for it.
    """

    def __init__(self, port: Door, patience: float, clock: Callable[[], float]) -> None:
        """Make it; ``restart`` connects.

        Args:
            port: where the controller is.
            patience: seconds without a byte until an answer is given up.
            clock: seconds of a clock that only grows.
        """
        self._port, self._clock = port, clock
        self._link, self._conversation = port.link(), port.conversation()
        self.messages: list[str] = []
        self.patience = patience
        self.gives_way: Callable[[], bool] = lambda: False

    @property
    def handshake(self) -> str:
        """The assignments that the conversation needs."""
        return self._conversation.handshake

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """As ``exchange.Conversation``."""
        return self._conversation.lines_at_once(lines)

    def restart(self, control: int | None = None) -> None:
        """Connect again; controller and conversation forget what was outstanding.

        Args:
            control: code of a control character that goes out before anything else.

        Raises:
            LinkLostError: the controller does not answer.
        """
        self._conversation = self._port.conversation()
        self._link.restart()
        ended = self.run(None, control)
        if isinstance(ended, Lost):
            raise LinkLostError(ended.why)

    def close(self) -> None:
        """Disconnect."""
        self._link.close()

    def query(self, text: str) -> tuple[str, ...]:
        """The answer to a query that is asked once.

        Raises:
            RefusedError: the controller does not answer it.
            LinkLostError: it makes no sense.
        """
        ended = self.run(Command(text, Kind.QUERY, self.patience))
        if isinstance(ended, Answer):
            return ended.lines
        if isinstance(ended, Refusal):
            raise RefusedError(text, ended.number, ended.words)
        raise LinkLostError(ended.why)

    def blind(self, text: str) -> str:
        """What a controller says whose handshake is not known.

        Raises:
            LinkLostError: it cannot be told.
        """
        ended = self.run(Command(text, Kind.BLIND, 3 * self._port.silence))
        if isinstance(ended, Lost):
            raise LinkLostError(ended.why)
        return "\n".join(ended.lines) if isinstance(ended, Answer) else ""

    def run(self, command: Command | None, control: int | None = None) -> Ending:
        """One exchange, or a reset with the control character that goes before it; the event that ended it.

        Raises:
            LinkLostError: the link is cut.
            CancelledError: it was a query that took long, and something more urgent waits.
        """
        conversation, began = self._conversation, self._clock()
        if command is None:
            conversation.reset(began, control)
        else:
            conversation.begin(command, began)
        may_give_way = command is not None and command.kind is Kind.QUERY
        while True:
            ended = self._ending()
            self._send()
            if ended is not None:
                return ended
            if may_give_way and self._clock() - began > LONG_S and self.gives_way():
                raise CancelledError("not carried out, or not to its end: a stop came first")
            self._listen()

    def _ending(self) -> Ending | None:
        for event in self._conversation.events():
            if not isinstance(event, Message):
                return event
            self.messages.append(event.text)
        return None

    def _send(self) -> None:
        data = self._conversation.outgoing()
        if data:
            self._link.write(data)

    def _listen(self) -> None:
        deadline = self._conversation.deadline
        assert deadline is not None
        data = self._link.read(deadline - self._clock())
        if data:
            self._conversation.receive(data, self._clock())
        elif self._clock() >= deadline:
            self._conversation.expire(self._clock())
