# SPDX-License-Identifier: LGPL-2.1-or-later
"""Serve: the simulated controller behind a TCP port of this computer or a pseudo terminal, in real or scaled time.

Enters: bytes of clients and the clock of the computer. Leaves: bytes. One thread does all, so that nothing happens to
the controller at once. Connections from other computers are not taken.
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
PERIOD_S = 0.005
LONGEST_LAPSE_S = 0.25
"""A computer that cannot keep up, or slept, does not make the motors jump: simulated time falls behind."""
LONGEST_TURN_S = 0.02
"""Clients are not kept waiting longer than this while simulated time passes."""
SLICE_MS = 20.0
PIECE = 4096


class Stream(Protocol):
    """Bytes in, bytes out."""

    def receive(self, data: bytes) -> bytes:
        """Take bytes in and give those out that answer them."""


@dataclass
class Channel:
    """One client: how its bytes are read and written, and what is not written yet."""

    read: Callable[[int], bytes]
    write: Callable[[bytes], int]
    close: Callable[[], None]
    stream: Stream
    unsent: bytearray = field(default_factory=bytearray)


class Server:
    """A controller and the doors to it."""

    def __init__(self, controller: Controller, speed: float = 1.0) -> None:
        self._controller, self._speed = controller, speed
        self._selector = selectors.DefaultSelector()
        self._ethernet, self._channels = Line(controller), dict[object, Channel]()
        self._closers: list[Callable[[], None]] = []
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
        self._selector.register(listener, selectors.EVENT_READ, lambda: self._accept(listener))
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
            ready = self._selector.select(PERIOD_S)
            now = time.monotonic()
            self._pass(1000 * self._speed * min(now - before, LONGEST_LAPSE_S))
            before = now
            for key, _ in ready:
                key.data()
            for line, channel in self._serial:
                channel.unsent += line.said()
            for source, channel in list(self._channels.items()):
                self._send(source, channel)

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

    def _accept(self, listener: socket.socket) -> None:
        connection, _ = listener.accept()
        connection.setblocking(False)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        channel = Channel(connection.recv, connection.send, connection.close, Packets(self._ethernet))
        self._watch(connection, channel)

    def _watch(self, source: int | socket.socket, channel: Channel) -> None:
        self._channels[source] = channel
        self._selector.register(source, selectors.EVENT_READ, lambda: self._receive(source, channel))

    def _receive(self, source: int | socket.socket, channel: Channel) -> None:
        try:
            data = channel.read(PIECE)
        except BlockingIOError:
            return
        except OSError:
            data = b""  # the client is gone, in whatever way
        if data:
            channel.unsent += channel.stream.receive(data)
        else:
            self._drop(source, channel)

    def _send(self, source: object, channel: Channel) -> None:
        try:
            while channel.unsent:
                del channel.unsent[: channel.write(bytes(channel.unsent[:PIECE]))]
        except BlockingIOError:
            return  # the rest follows when the client has read
        except OSError:
            self._drop(source, channel)

    def _drop(self, source: object, channel: Channel) -> None:
        if self._channels.pop(source, None) is not None:
            self._selector.unregister(source)  # type: ignore[arg-type]
            channel.close()
