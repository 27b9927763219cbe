# SPDX-License-Identifier: LGPL-2.1-or-later
"""Command channel: a link, a protocol and a clock. A command goes out; its outcome comes back, or it times out.

A controller may be in any state when the link connects. If a program buffer is open, an assignment would become a line
of the program. So the handshake starts with the query ``SIZE``, whose sign reveals an open buffer, and sets only values
that are wrong.

Input: commands. Output: the outcome of each; exceptions of the link propagate.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from enum import Enum

from pkm_post.control.link.errors import CancelledError, LinkLostError
from pkm_post.control.link.ports import PortInterface
from pkm_post.control.link.protocol import Answer, CommandKind, ControllerCommand, Lost, Message, Refusal

LONG_QUERY_S = 0.5
"""A longer query may be preempted by something more urgent; reconnecting takes about as long."""

_Outcome = Answer | Refusal | Lost


class CommandChannel:
    """Executes commands in sequence.

    Attributes:
        messages: unsolicited messages from programs in the controller.
        answer_timeout: timeout of an answer: seconds without a byte.
        is_preempted: polled during a long query: whether something more urgent is waiting.
    """

    def __init__(self, port: PortInterface, answer_timeout: float, clock: Callable[[], float]) -> None:
        """Create the channel; ``restart`` connects.

        Args:
            port: of the controller.
            answer_timeout: timeout of an answer: seconds without a byte.
            clock: monotonic clock, s.
        """
        self._port, self._clock = port, clock
        self._link, self._protocol = port.link(), port.protocol()
        self.messages: list[str] = []
        self.answer_timeout = answer_timeout
        self.is_preempted: Callable[[], bool] = lambda: False

    @property
    def handshake(self) -> str:
        """The assignments that the protocol requires."""
        return self._protocol.handshake

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """As ``CommandProtocol``."""
        return self._protocol.lines_at_once(lines)

    def restart(self, control: int | None = None) -> None:
        """Reconnect; controller and protocol drop all outstanding work.

        Args:
            control: code of a control character to send first.

        Raises:
            LinkLostError: the controller does not answer.
        """
        self._protocol = self._port.protocol()
        self._link.restart()
        outcome = self.run(None, control)
        if isinstance(outcome, Lost):
            raise LinkLostError(outcome.why)

    def close(self) -> None:
        """Disconnect."""
        self._link.close()

    def blind(self, text: str) -> str:
        """The answer of a controller whose handshake is unknown.

        Raises:
            LinkLostError: the exchange failed.
        """
        outcome = self.run(ControllerCommand(text, CommandKind.BLIND, 3 * self._port.silence))
        if isinstance(outcome, Lost):
            raise LinkLostError(outcome.why)
        return "\n".join(outcome.lines) if isinstance(outcome, Answer) else ""

    def run(self, command: ControllerCommand | None, control: int | None = None) -> _Outcome:
        """Run one exchange, or a reset with an optional control character; return the event that ends it.

        Raises:
            LinkLostError: the link is cut.
            CancelledError: something more urgent preempts a long query.
        """
        protocol, began = self._protocol, self._clock()
        if command is None:
            protocol.reset(began, control)
        else:
            protocol.begin(command, began)
        is_preemptible = command is not None and command.kind is CommandKind.QUERY
        while True:
            outcome = self._outcome()
            self._send()
            if outcome is not None:
                return outcome
            if is_preemptible and self._clock() - began > LONG_QUERY_S and self.is_preempted():
                raise CancelledError("not executed, or not completed: a stop came first")
            self._listen()

    def _outcome(self) -> _Outcome | None:
        for event in self._protocol.events():
            if not isinstance(event, Message):
                return event
            self.messages.append(event.text)
        return None

    def _send(self) -> None:
        data = self._protocol.outgoing()
        if data:
            self._link.write(data)

    def _listen(self) -> None:
        deadline = self._protocol.deadline
        assert deadline is not None
        data = self._link.read(deadline - self._clock())
        if data:
            self._protocol.receive(data, self._clock())
        elif self._clock() >= deadline:
            self._protocol.expire(self._clock())


class OpenBufferPolicy(Enum):
    """Treatment of a program buffer that is open when connecting."""

    LEAVE = "leave"
    """Leave it: monitoring must not disturb its owner, and loading checks for one first (``ownership``)."""
    STOP = "stop"
    """Leave it if the handshake is correct, else close it: a stop takes precedence over a download."""
    CLOSE = "close"
    """Close it: its owner reconnects and queries its contents."""


_HANDSHAKE = re.compile(r"(I\d+)=(\d+)")
_NEGATIVE = re.compile(r"(?:^|[^0-9A-Za-z$.])-\s?\d+")


def establish_handshake(channel: CommandChannel, open_buffer: OpenBufferPolicy) -> None:
    """Connect and establish the handshake.

    Raises:
        LinkLostError: the controller does not answer, or does not accept the handshake.
    """
    channel.restart()
    if not channel.handshake:
        return
    is_open = _has_open_buffer(channel)
    if open_buffer is OpenBufferPolicy.CLOSE:
        channel.blind("CLOSE")
    if _has_handshake(channel):
        return  # an assignment might end up in another client's download
    if is_open and open_buffer is OpenBufferPolicy.LEAVE:
        raise LinkLostError("a program buffer is open, and the handshake differs: abort closes the buffer")
    channel.blind("CLOSE")
    channel.blind(channel.handshake)
    if not _has_handshake(channel):
        raise LinkLostError(f"the controller does not accept {channel.handshake}")


def _has_handshake(channel: CommandChannel) -> bool:
    """Whether the controller answers in the form that the protocol expects; with I9=3 in whole statements."""
    names, values = zip(*_HANDSHAKE.findall(channel.handshake), strict=True)
    outcome = channel.run(ControllerCommand(" ".join(names), CommandKind.QUERY, channel.answer_timeout))
    return isinstance(outcome, Answer) and tuple(line.rpartition("=")[2] for line in outcome.lines) == values


def _has_open_buffer(channel: CommandChannel) -> bool:
    """SIZE is negative while a program buffer is open; the framing of the answer is still unknown."""
    size = channel.blind("SIZE")
    if not re.search(r"\d", size):
        raise LinkLostError(f"SIZE: expected a number of words, got {size!r}")
    return bool(_NEGATIVE.search(size))
