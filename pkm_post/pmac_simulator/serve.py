# SPDX-License-Identifier: LGPL-2.1-or-later
"""Serve: the simulated controller behind a TCP port of this computer or a pseudo terminal, in real or scaled time.

Enters: bytes of clients and the clock of the computer. Leaves: bytes. One thread does all, so that nothing happens to
the controller at once. Connections from other computers are not taken.

No client keeps the others waiting: each has its share of a turn, and from one that does not read its answers nothing is
read any more. When the system has no more file descriptors, those who come wait until it has.
"""

from __future__ import annotations

import os
import selectors
import socket
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from pkm_post.pmac_simulator.controller import Controller
from pkm_post.pmac_simulator.ethernet import Packets
from pkm_post.pmac_simulator.line import Line

LOOPBACK = "127.0.0.1"
WITHOUT_SIGNAL = getattr(socket, "MSG_NOSIGNAL", 0)
"""FreeCAD leaves SIGPIPE at its default: a client that has gone would end it."""
PERIOD_S = 0.005
LONGEST_LAPSE_S = 0.25
"""A computer that cannot keep up, or slept, does not make the motors jump: simulated time falls behind."""
LONGEST_TURN_S = 0.02
"""Clients are not kept waiting longer than this while simulated time passes."""
SLICE_MS = 20.0
PIECE = 4096
MORSEL = 64
"""So many bytes of a client are taken in at once; they may ask for much."""
SHARE_S = 0.005
"""Of a turn, for each client."""
MOST_UNSENT = 1 << 20
"""Bytes that wait for a client to read them; from then on it is not listened to."""
NO_DESCRIPTOR_S = 0.1
"""Seconds until connections are taken again when the system could not take one."""


class Stream(Protocol):
    """Bytes in, bytes out."""

    def receive(self, data: bytes) -> bytes:
        """Take bytes in and give those out that answer them."""


@dataclass
class Channel:
    """One client: how its bytes are read and written, what is not taken in yet, and what is not written yet."""

    read: Callable[[int], bytes]
    write: Callable[[bytes], int]
    close: Callable[[], None]
    stream: Stream
    untaken: bytearray = field(default_factory=bytearray)
    unsent: bytearray = field(default_factory=bytearray)

    @property
    def is_heard(self) -> bool:
        """Whether it reads what it is sent, so that it may say more."""
        return len(self.unsent) < MOST_UNSENT

    def take(self) -> None:
        """Take in what it has said, for its share of a turn."""
        end = time.monotonic() + SHARE_S
        while self.untaken and self.is_heard and time.monotonic() < end:
            morsel = bytes(self.untaken[:MORSEL])
            del self.untaken[:MORSEL]
            self.unsent += self.stream.receive(morsel)


class Server:
    """A controller and the doors to it."""

    def __init__(self, controller: Controller, speed: float = 1.0) -> None:
        self._controller, self._speed = controller, speed
        self._selector = selectors.DefaultSelector()
        self._ethernet, self._channels = Line(controller), dict[int | socket.socket, Channel]()
        self._closers: list[Callable[[], None]] = []
        self._listeners: dict[socket.socket, float] = {}
        self._serial: list[tuple[Line, Channel]] = []

    def add_tcp(self, port: int) -> int:
        """Listen at a TCP port of this computer; 0 takes a free one.

        Returns:
            The port.

        Raises:
            OSError: the port is taken.
        """
        listener = socket.create_server((LOOPBACK, port))
        listener.setblocking(False)
        self._listen(listener)
        self._closers.append(listener.close)
        return int(listener.getsockname()[1])

    def add_pty(self) -> str:
        """Make a pseudo terminal.

        Returns:
            The path that clients open as a serial port.

        Raises:
            OSError: the system has none.
        """
        if not hasattr(os, "openpty"):
            raise OSError("this system has no pseudo terminals")
        import tty

        ours, theirs = os.openpty()
        tty.setraw(theirs)
        os.set_blocking(ours, False)
        # Their end stays open here: without it a client that leaves would look like a broken device.
        self._closers += [lambda: os.close(ours), lambda: os.close(theirs)]
        line = Line(self._controller)
        line.attend()
        channel = Channel(lambda size: os.read(ours, size), lambda data: os.write(ours, data), lambda: None, line)
        self._serial.append((line, channel))
        self._watch(ours, channel)
        return os.ttyname(theirs)

    def run(self, ended: Callable[[], bool]) -> None:
        """Serve until ``ended`` says so."""
        before = time.monotonic()
        while not ended():
            ready = self._selector.select(0 if self._has_untaken() else PERIOD_S)
            now = time.monotonic()
            self._pass(1000 * self._speed * min(now - before, LONGEST_LAPSE_S))
            before = now
            for key, _ in ready:
                key.data()
            for line, channel in self._serial:
                said = line.said()
                channel.unsent += said if channel.is_heard else b""
            for source, channel in list(self._channels.items()):
                channel.take()
                self._send(source, channel)
                self._hear(source, channel)
            self._listen_again(now)

    def _pass(self, ms: float) -> None:
        """Let simulated time pass; what does not fit into a turn is lost."""
        end = time.monotonic() + LONGEST_TURN_S
        while ms > 0.0 and time.monotonic() < end:
            self._controller.advance(min(ms, SLICE_MS))
            ms -= SLICE_MS

    def close(self) -> None:
        """Close all doors."""
        for channel in self._channels.values():
            channel.close()
        for closer in self._closers:
            closer()
        self._selector.close()

    def _listen(self, listener: socket.socket) -> None:
        self._selector.register(listener, selectors.EVENT_READ, lambda: self._accept(listener))

    def _listen_again(self, now: float) -> None:
        for listener, due in list(self._listeners.items()):
            if now >= due:
                del self._listeners[listener]
                self._listen(listener)

    def _has_untaken(self) -> bool:
        return any(channel.untaken and channel.is_heard for channel in self._channels.values())

    def _accept(self, listener: socket.socket) -> None:
        try:
            connection, _ = listener.accept()
        except OSError:  # no descriptor for it, or it has gone again: the others are served meanwhile
            self._selector.unregister(listener)
            self._listeners[listener] = time.monotonic() + NO_DESCRIPTOR_S
            return
        connection.setblocking(False)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

        def send(data: bytes) -> int:
            return connection.send(data, WITHOUT_SIGNAL)

        self._watch(connection, Channel(connection.recv, send, connection.close, Packets(self._ethernet)))

    def _watch(self, source: int | socket.socket, channel: Channel) -> None:
        self._channels[source] = channel
        self._hear(source, channel)

    def _hear(self, source: int | socket.socket, channel: Channel) -> None:
        """Read from a client as long as it reads itself, and what it said was taken in."""
        if source not in self._channels:
            return  # it was dropped
        is_watched = source in self._selector.get_map()
        wants = channel.is_heard and not channel.untaken
        if wants and not is_watched:
            self._selector.register(source, selectors.EVENT_READ, lambda: self._receive(source, channel))
        elif is_watched and not wants:
            self._selector.unregister(source)

    def _receive(self, source: int | socket.socket, channel: Channel) -> None:
        try:
            data = channel.read(PIECE)
        except BlockingIOError:
            return
        except OSError:
            data = b""  # the client is gone, in whatever way
        if data:
            channel.untaken += data
        else:
            self._drop(source, channel)

    def _send(self, source: int | socket.socket, channel: Channel) -> None:
        try:
            while channel.unsent:
                del channel.unsent[: channel.write(bytes(channel.unsent[:PIECE]))]
        except BlockingIOError:
            return  # the rest follows when the client has read
        except OSError:
            self._drop(source, channel)

    def _drop(self, source: int | socket.socket, channel: Channel) -> None:
        if self._channels.pop(source, None) is not None:
            if source in self._selector.get_map():
                self._selector.unregister(source)
            channel.close()
