# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dialogue: combines a link, a conversation and a clock. One command goes out, one event comes back, with a timeout.

Enters: commands. Leaves: the event that ended each; exceptions of the link propagate.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from enum import Enum

from pkm_post.control.link.errors import CancelledError, LinkLostError, RefusedError
from pkm_post.control.link.ports import PortInterface
from pkm_post.control.link.protocol import Answer, Command, CommandKind, Lost, Message, Refusal

LONG_S = 0.5
"""A query that takes longer may be dropped for something more urgent; reconnecting takes about as long."""

_Outcome = Answer | Refusal | Lost


class CommandChannel:
    """Executes commands one after the other.

    Attributes:
        messages: unsolicited messages from programs in the controller.
        patience: seconds without a byte before an answer is given up.
        gives_way: called during a long query: whether something more urgent waits.
    """

    def __init__(self, port: PortInterface, patience: float, clock: Callable[[], float]) -> None:
        """Create the dialogue; ``restart`` connects.

        Args:
            port: of the controller.
            patience: seconds without a byte before an answer is given up.
            clock: monotonic clock, s.
        """
        self._port, self._clock = port, clock
        self._link, self._conversation = port.link(), port.conversation()
        self.messages: list[str] = []
        self.patience = patience
        self.gives_way: Callable[[], bool] = lambda: False

    @property
    def handshake(self) -> str:
        """The assignments that the conversation requires."""
        return self._conversation.handshake

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """As ``exchange.Conversation``."""
        return self._conversation.lines_at_once(lines)

    def restart(self, control: int | None = None) -> None:
        """Reconnect; controller and conversation drop whatever was outstanding.

        Args:
            control: code of a control character sent before anything else.

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
        """The answer to a query, without retries.

        Raises:
            RefusedError: the controller refuses it.
            LinkLostError: the answer makes no sense.
        """
        ended = self.run(Command(text, CommandKind.QUERY, self.patience))
        if isinstance(ended, Answer):
            return ended.lines
        if isinstance(ended, Refusal):
            raise RefusedError(text, ended.number, ended.words)
        raise LinkLostError(ended.why)

    def blind(self, text: str) -> str:
        """The answer of a controller whose handshake is unknown.

        Raises:
            LinkLostError: the exchange failed.
        """
        ended = self.run(Command(text, CommandKind.BLIND, 3 * self._port.silence))
        if isinstance(ended, Lost):
            raise LinkLostError(ended.why)
        return "\n".join(ended.lines) if isinstance(ended, Answer) else ""

    def run(self, command: Command | None, control: int | None = None) -> _Outcome:
        """Run one exchange, or a reset with an optional control character; return the event that ended it.

        Raises:
            LinkLostError: the link is cut.
            CancelledError: a query took long while something more urgent waits.
        """
        conversation, began = self._conversation, self._clock()
        if command is None:
            conversation.reset(began, control)
        else:
            conversation.begin(command, began)
        may_give_way = command is not None and command.kind is CommandKind.QUERY
        while True:
            ended = self._ending()
            self._send()
            if ended is not None:
                return ended
            if may_give_way and self._clock() - began > LONG_S and self.gives_way():
                raise CancelledError("not carried out, or not to its end: a stop came first")
            self._listen()

    def _ending(self) -> _Outcome | None:
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


class OpenBufferPolicy(Enum):
    """What to do with a program buffer that is open when connecting."""

    LEAVE = "leave"
    """Leave it: a client that only monitors disturbs no one, and loading checks its owner first (``ownership``)."""
    STOP = "stop"
    """Leave it if the handshake is as agreed, else close it: a stop takes precedence over a download."""
    CLOSE = "close"
    """Close it: its owner reconnects and queries its contents."""


_HANDSHAKE = re.compile(r"(I\d+)=(\d+)")
_NEGATIVE = re.compile(r"(?:^|[^0-9A-Za-z$.])-\s?\d+")


def establish_handshake(dialogue: CommandChannel, leftover: OpenBufferPolicy) -> None:
    """Connect and establish the handshake.

    Raises:
        LinkLostError: the controller does not answer, or not as agreed.
    """
    dialogue.restart()
    if not dialogue.handshake:
        return
    is_open = _finds_open_buffer(dialogue)
    if leftover is OpenBufferPolicy.CLOSE:
        dialogue.blind("CLOSE")
    if _is_agreed(dialogue):
        return  # an assignment might become a line of a download that another client is starting
    if is_open and leftover is OpenBufferPolicy.LEAVE:
        raise LinkLostError("a program buffer is open, and the answers are not as is agreed: abort closes it")
    dialogue.blind("CLOSE")
    dialogue.blind(dialogue.handshake)
    if not _is_agreed(dialogue):
        raise LinkLostError(f"the controller does not keep {dialogue.handshake}")


def _is_agreed(dialogue: CommandChannel) -> bool:
    """Whether the controller answers in the form that the conversation expects."""
    names, values = zip(*_HANDSHAKE.findall(dialogue.handshake), strict=True)
    ended = dialogue.run(Command(" ".join(names), CommandKind.QUERY, dialogue.patience))
    return isinstance(ended, Answer) and ended.lines == values


def _finds_open_buffer(dialogue: CommandChannel) -> bool:
    """SIZE is negative while a program buffer is open; the framing of the answer is still unknown."""
    told = dialogue.blind("SIZE")
    if not re.search(r"\d", told):
        raise LinkLostError(f"SIZE: expected a number of words, got {told!r}")
    return bool(_NEGATIVE.search(told))
