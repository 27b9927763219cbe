# SPDX-License-Identifier: LGPL-2.1-or-later
"""Session: a link and a conversation together, with a clock. Queries are asked again, sets are not.

Enters: the text of commands. Leaves: the lines of the answers, or an exception: ``RefusedError`` with the controller's
number, ``OutcomeUnknownError`` for a set that may or may not have been carried out, ``LinkLostError``.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence
from enum import Enum
from types import TracebackType
from typing import Self

from pkm_post.pmac_link.exchange import Answer, Command, Kind, Lost, Message, Refusal
from pkm_post.pmac_link.faults import LinkLostError, NotReadyError, OutcomeUnknownError, RefusedError
from pkm_post.pmac_link.ports import Door

ATTEMPTS = 5
"""How often a query is asked."""
CALLS = 3
"""How often a lost link is called back at once."""


class Leftover(Enum):
    """What becomes of a program buffer that is found open while connecting."""

    REFUSE = "refuse"
    """Somebody may be loading a program: nothing is done."""
    JOIN = "join"
    """As well, but a rotary buffer with lines in it is left open: who only asks, or goes on, does not disturb it."""
    CLEAR = "clear"
    """It is made empty and closed: the rest of a download that was cut must not be run. A rotary one is joined."""
    CLOSE = "close"
    """It is closed as it is, by a download that asks what is in it."""


_TIMID = (Leftover.REFUSE, Leftover.JOIN)
_HANDSHAKE = re.compile(r"(I\d+)=(\d+)")
_NEGATIVE = re.compile(r"(?:^|[^0-9A-Za-z$.])-\s?\d+")


class Session:
    """A controller that answers.

    Attributes:
        messages: what programs in the controller sent of their own accord.
        notes: what was found and done while connecting, in words.
        connections: how often it has connected; a program buffer that was open before is closed since.
    """

    def __init__(
        self,
        port: Door,
        patience: float = 2.0,
        pause: float = 0.5,
        leftover: Leftover = Leftover.REFUSE,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        """Make a session; ``open`` connects.

        Args:
            port: where the controller is.
            patience: seconds without a byte until an answer is given up.
            pause: seconds before a lost link is called back, longer each time.
            leftover: what becomes of a program buffer that ``open`` finds open.
            clock: seconds of a clock that only grows.
            sleep: waits so many seconds of it.
        """
        self._port, self._patience, self._pause = port, patience, pause
        self._leftover = leftover
        self._clock, self._sleep = clock, sleep
        self._link, self._conversation = port.link(), port.conversation()
        self._in_step = False
        self.messages: list[str] = []
        self.notes: list[str] = []
        self.connections = 0

    def __enter__(self) -> Self:
        self.open()
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def open(self) -> None:
        """Connect and agree on the handshake.

        Raises:
            LinkLostError: no controller answers.
            NotReadyError: a program buffer is open, and it is not this session's to clear.
        """
        self._call(self._leftover)

    def close(self) -> None:
        """Disconnect."""
        self._link.close()
        self._in_step = False

    def now(self) -> float:
        """Seconds of the clock of this session."""
        return self._clock()

    def ask(self, text: str, most: int = 1 << 16) -> tuple[str, ...]:
        """The lines of the answer to a query.

        Args:
            text: the query; it changes nothing, for it may be sent several times.
            most: bytes of the answer that are taken.

        Raises:
            RefusedError: the controller does not answer it.
            LinkLostError: it was asked ``ATTEMPTS`` times and got no answer.
        """
        command = Command(text, Kind.QUERY, self._patience, most)
        for attempt in range(ATTEMPTS):
            try:
                return self._exchange(command)
            except LinkLostError:
                if attempt == ATTEMPTS - 1:
                    raise
        raise AssertionError("unreachable")

    def order(self, text: str) -> tuple[str, ...]:
        """Have a command carried out, once; what it says.

        Raises:
            RefusedError: the controller refused it.
            OutcomeUnknownError: it may or may not have been carried out.
            LinkLostError: it surely was not.
        """
        return self._exchange(Command(text, Kind.SET, self._patience))

    def load(self, lines: Sequence[str]) -> int:
        """Put some lines into the open program buffer: as many as one exchange takes; their number.

        Args:
            lines: at least one.

        Raises:
            RefusedError: a line was refused.
            OutcomeUnknownError: they may or may not be in the buffer.
            LinkLostError: they are not.
        """
        count = self.lines_at_once(lines)
        if not count:
            raise ValueError(f"lines: expected lines that fit into one exchange, got {lines[:1]}")
        self._exchange(Command("\n".join(lines[:count]), Kind.BUFFER, self._patience))
        return count

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """How many of these lines ``load`` puts into the buffer in one exchange."""
        return self._conversation.lines_at_once(lines)

    def _exchange(self, command: Command) -> tuple[str, ...]:
        if not self._in_step:
            self._call(self._leftover if self._leftover in _TIMID else Leftover.CLOSE)
        self._in_step = False  # until the end is known: an interrupt may come at any time
        try:
            ended = self._run(command)
        except LinkLostError as lost:
            ended = Lost(str(lost))
        self._in_step = not isinstance(ended, Lost)
        if isinstance(ended, Answer):
            return ended.lines
        if isinstance(ended, Refusal):
            raise RefusedError(command.text.split("\n")[ended.line], ended.number, ended.words)
        if command.kind is Kind.QUERY or ended.untouched:
            raise LinkLostError(f"{command.text[:60]!r}: {ended.why}")
        raise OutcomeUnknownError(command.text[:60], ended.why)

    def _run(self, command: Command | None) -> Answer | Refusal | Lost:
        """One exchange, or a reset; the event that ended it."""
        conversation = self._conversation
        if command is None:
            conversation.reset(self._clock())
        else:
            conversation.begin(command, self._clock())
        while True:
            for event in conversation.events():
                if not isinstance(event, Message):
                    self._send()
                    return event
                self.messages.append(event.text)
            self._send()
            deadline = conversation.deadline
            assert deadline is not None
            data = self._link.read(deadline - self._clock())
            if data:
                conversation.receive(data, self._clock())
            elif self._clock() >= deadline:
                conversation.expire(self._clock())

    def _send(self) -> None:
        data = self._conversation.outgoing()
        if data:
            self._link.write(data)

    def _call(self, leftover: Leftover) -> None:
        """Connect, several times if need be."""
        for attempt in range(CALLS):
            if attempt:
                self._sleep(self._pause * attempt)
            try:
                self._greet(leftover)
            except (LinkLostError, RefusedError) as fault:
                if attempt == CALLS - 1:
                    raise LinkLostError(f"no controller that can be understood: {fault}") from fault
            else:
                self._in_step = True
                self.connections += 1
                return

    def _greet(self, leftover: Leftover) -> None:
        """Agree on the handshake with a controller of which nothing is known yet."""
        self._conversation = self._port.conversation()
        self._link.restart()
        ended = self._run(None)
        if isinstance(ended, Lost):
            raise LinkLostError(ended.why)
        wanted = self._conversation.handshake
        if not wanted:
            return
        # In an open buffer an assignment would become a line of the program.
        is_open = self._finds_open_buffer()
        ahead = self._lines_ahead() if is_open and leftover in (Leftover.JOIN, Leftover.CLEAR) else 0
        if ahead:
            self.notes.append(f"a rotary buffer is open, with {ahead} lines ahead of its program")
            if self._is_agreed(wanted):
                return  # who streams must not lose them in the middle of a move
        if is_open and leftover in _TIMID:
            raise NotReadyError(
                ["a program buffer is open: somebody loads a program, or a download was cut; no program runs meanwhile"]
            )
        if is_open and leftover is Leftover.CLEAR and not ahead:
            self._blind("CLEAR")
        if leftover not in _TIMID:
            self._blind("CLOSE")
        self._blind(wanted)
        if not self._is_agreed(wanted):
            raise LinkLostError(f"the controller does not keep {wanted}")
        if is_open and leftover is Leftover.CLEAR and not ahead:
            self._note_open_buffer()

    def _is_agreed(self, wanted: str) -> bool:
        """Whether the controller answers as this conversation expects."""
        names, values = zip(*_HANDSHAKE.findall(wanted), strict=True)
        try:
            return self._judged(Command(" ".join(names), Kind.QUERY, self._patience)) == values
        except (LinkLostError, RefusedError):
            return False

    def _lines_ahead(self) -> int:
        """Lines in the rotary buffer that the program has not begun."""
        found = re.match(r"\s*(\d+)", self._blind("PR"))
        return int(found[1]) if found else 0

    def _finds_open_buffer(self) -> bool:
        """SIZE is negative while a program buffer is open; asked while nobody knows how the answer is framed."""
        told = self._blind("SIZE")
        if not re.search(r"\d", told):
            raise LinkLostError(f"SIZE: expected a number of words, got {told!r}")
        return bool(_NEGATIVE.search(told))

    def _note_open_buffer(self) -> None:
        (free,) = self._judged(Command("SIZE", Kind.QUERY, self._patience))[:1] or ("",)
        self.notes.append(
            "a program buffer is open on another port of the controller: somebody else is loading a program"
            if free.startswith("-")
            else "a program buffer was open, the rest of a download that was cut: it was made empty"
        )

    def _blind(self, text: str) -> str:
        """What a controller says whose handshake is not known."""
        ended = self._run(Command(text, Kind.BLIND, 3 * self._port.silence))
        if isinstance(ended, Lost):
            raise LinkLostError(ended.why)
        return "\n".join(ended.lines) if isinstance(ended, Answer) else ""

    def _judged(self, command: Command) -> tuple[str, ...]:
        ended = self._run(command)
        if isinstance(ended, Answer):
            return ended.lines
        if isinstance(ended, Refusal):
            raise RefusedError(command.text, ended.number, ended.words)
        raise LinkLostError(ended.why)
