# SPDX-License-Identifier: LGPL-2.1-or-later
"""Serve: the simulated controller on a local TCP port, a pseudo terminal or ssh, in real or scaled time.

Input: bytes from clients and the computer's clock. Output: bytes. A single thread does everything, so access to the
controller is serialized. Connections from other computers are not accepted.

No client blocks the others: each has a share of a turn, and a client that does not read its answers is no longer read
from. When the system runs out of file descriptors, new connections wait until one is free.
"""

from __future__ import annotations

import os
import selectors
import socket
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from types import ModuleType
from typing import Protocol

from pkm_post.control.simulator.controller import Controller
from pkm_post.control.simulator.ethernet_port import EthernetPort
from pkm_post.control.simulator.gpascii_shell import GpasciiShell
from pkm_post.control.simulator.power_online import PowerPmac
from pkm_post.control.simulator.serial_port import SerialPort
from pkm_post.control.simulator.ssh_server import SshServer

LOOPBACK = "127.0.0.1"
WITHOUT_SIGNAL = getattr(socket, "MSG_NOSIGNAL", 0)
"""FreeCAD leaves SIGPIPE at its default: a disconnected client would end the process."""
PERIOD_S = 0.005
LONGEST_LAPSE_S = 0.25
"""After a lag or a sleep of the computer the motors do not jump: simulated time falls behind."""
LONGEST_TURN_S = 0.02
"""Clients wait no longer than this while simulated time advances."""
SLICE_MS = 20.0
PIECE = 4096
MORSEL = 64
"""Bytes of a client processed at once, as they may request a lot."""
SHARE_S = 0.005
"""Time per client in a turn."""
MOST_UNSENT = 1 << 20
"""Most bytes waiting for a client to read; beyond this it is no longer read from."""
NO_DESCRIPTOR_S = 0.1
"""Seconds until connections are accepted again after the system refused one."""


class ByteStream(Protocol):
    """Bytes in, bytes out."""

    def receive(self, data: bytes) -> bytes:
        """Take received bytes and return the answers."""


@dataclass
class Channel:
    """One client: its read and write functions, bytes not yet processed, and bytes not yet sent."""

    read: Callable[[int], bytes]
    write: Callable[[bytes], int]
    close: Callable[[], None]
    stream: ByteStream
    untaken: bytearray = field(default_factory=bytearray)
    unsent: bytearray = field(default_factory=bytearray)

    @property
    def is_heard(self) -> bool:
        """Whether the client reads its answers, so that it may send more."""
        return len(self.unsent) < MOST_UNSENT

    def take(self) -> None:
        """Process received bytes, for its share of a turn."""
        end = time.monotonic() + SHARE_S
        while self.untaken and self.is_heard and time.monotonic() < end:
            morsel = bytes(self.untaken[:MORSEL])
            del self.untaken[:MORSEL]
            self.unsent += self.stream.receive(morsel)


class Server:
    """A controller and its ports."""

    def __init__(self, controller: Controller, speed: float = 1.0) -> None:
        self._controller, self._speed = controller, speed
        self._selector = selectors.DefaultSelector()
        self._ethernet, self._channels = SerialPort(controller), dict[int | socket.socket, Channel]()
        self._closers: list[Callable[[], None]] = []
        self._listeners: dict[socket.socket, tuple[float, Callable[[socket.socket], None]]] = {}
        self._serial: list[tuple[SerialPort, Channel]] = []
        self._log_ins: list[tuple[socket.socket, GpasciiShell]] = []

    def add_tcp(self, port: int) -> int:
        """Listen on a local TCP port; 0 selects a free one.

        Returns:
            The port.

        Raises:
            OSError: the port is taken.
        """
        return self._add_listener(port, lambda connection: self._attach(connection, EthernetPort(self._ethernet)))

    def add_shell(self, machine: PowerPmac) -> int:
        """Offer the shell of a Power PMAC's computer at a free local TCP port, without ssh, for the own process.

        Args:
            machine: the Power PMAC, whose controller this server serves.

        Returns:
            The port.

        Raises:
            OSError: there is no free port.
        """
        return self._add_listener(0, lambda connection: self._log_ins.append((connection, GpasciiShell(machine))))

    def _add_listener(self, port: int, attach: Callable[[socket.socket], None]) -> int:
        listener = socket.create_server((LOOPBACK, port))
        listener.setblocking(False)
        self._listen(listener, attach)
        self._closers.append(listener.close)
        return int(listener.getsockname()[1])

    def add_pty(self) -> str:
        """Open a pseudo terminal.

        Returns:
            The path for clients to open as a serial port.

        Raises:
            OSError: the system has no pseudo terminals.
        """
        if not hasattr(os, "openpty"):
            raise OSError("this system has no pseudo terminals")
        import tty

        ours, theirs = os.openpty()
        tty.setraw(theirs)
        os.set_blocking(ours, False)
        # The client end stays open here: otherwise a disconnecting client would look like a broken device.
        self._closers += [lambda: os.close(ours), lambda: os.close(theirs)]
        line = SerialPort(self._controller)
        line.attend()
        channel = Channel(lambda size: os.read(ours, size), lambda data: os.write(ours, data), lambda: None, line)
        self._serial.append((line, channel))
        self._watch(ours, channel)
        return os.ttyname(theirs)

    def add_ssh(self, machine: PowerPmac, ssh: ModuleType, port: int, password: str) -> SshServer:
        """Let users log in to the computer of a Power PMAC.

        Args:
            machine: the Power PMAC, whose controller this server serves.
            ssh: paramiko.
            port: local TCP port; 0 selects a free one.

        Raises:
            OSError: the port is taken.
        """

        def attach(connection: socket.socket) -> None:  # in another thread: the shell begins in ours
            self._log_ins.append((connection, GpasciiShell(machine)))

        door = SshServer(ssh, port, password, attach)
        self._closers.append(door.close)
        return door

    def run(self, ended: Callable[[], bool]) -> None:
        """Serve until ``ended`` returns true."""
        before = time.monotonic()
        while not ended():
            ready = self._selector.select(0 if self._has_untaken() else PERIOD_S)
            now = time.monotonic()
            self._pass(1000 * self._speed * min(now - before, LONGEST_LAPSE_S))
            before = now
            self._serve(ready)

    def serve(self) -> None:
        """Process received bytes of all clients once, without waiting; simulated time does not advance."""
        self._serve(self._selector.select(0))

    def _serve(self, ready: list[tuple[selectors.SelectorKey, int]]) -> None:
        self._take_log_ins()
        for key, _ in ready:
            key.data()
        for line, channel in self._serial:
            output = line.output()
            channel.unsent += output if channel.is_heard else b""
        for source, channel in list(self._channels.items()):
            channel.take()
            self._send(source, channel)
            self._hear(source, channel)
        self._listen_again(time.monotonic())

    def _pass(self, ms: float) -> None:
        """Advance simulated time; time that does not fit into a turn is lost."""
        end = time.monotonic() + LONGEST_TURN_S
        while ms > 0.0 and time.monotonic() < end:
            self._controller.advance(min(ms, SLICE_MS))
            ms -= SLICE_MS

    def close(self) -> None:
        """Close all ports."""
        for channel in self._channels.values():
            channel.close()
        for closer in self._closers:
            closer()
        self._selector.close()

    def _listen(self, listener: socket.socket, attach: Callable[[socket.socket], None]) -> None:
        self._selector.register(listener, selectors.EVENT_READ, lambda: self._accept(listener, attach))

    def _listen_again(self, now: float) -> None:
        for listener, (due, attach) in list(self._listeners.items()):
            if now >= due:
                del self._listeners[listener]
                self._listen(listener, attach)

    def _has_untaken(self) -> bool:
        return any(channel.untaken and channel.is_heard for channel in self._channels.values())

    def _accept(self, listener: socket.socket, attach: Callable[[socket.socket], None]) -> None:
        try:
            connection, _ = listener.accept()
        except OSError:  # out of descriptors, or the client has disconnected: serve the others meanwhile
            self._selector.unregister(listener)
            self._listeners[listener] = time.monotonic() + NO_DESCRIPTOR_S, attach
            return
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        attach(connection)

    def _attach(self, connection: socket.socket, port: EthernetPort) -> None:
        connection.setblocking(False)
        self._watch(connection, Channel(connection.recv, _sender(connection), connection.close, port))

    def _take_log_ins(self) -> None:
        while self._log_ins:
            connection, shell = self._log_ins.pop(0)
            connection.setblocking(False)
            channel = Channel(connection.recv, _sender(connection), _ender(connection, shell), shell)
            channel.unsent += shell.greeting()
            self._watch(connection, channel)

    def _watch(self, source: int | socket.socket, channel: Channel) -> None:
        self._channels[source] = channel
        self._hear(source, channel)

    def _hear(self, source: int | socket.socket, channel: Channel) -> None:
        """Read from a client while it reads its answers and its previous bytes are processed."""
        if source not in self._channels:
            return  # dropped before
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
            data = b""  # the client has disconnected, one way or another
        if data:
            channel.untaken += data
        else:
            self._drop(source, channel)

    def _send(self, source: int | socket.socket, channel: Channel) -> None:
        try:
            while channel.unsent:
                del channel.unsent[: channel.write(bytes(channel.unsent[:PIECE]))]
        except BlockingIOError:
            return  # the rest follows once the client has read
        except OSError:
            self._drop(source, channel)

    def _drop(self, source: int | socket.socket, channel: Channel) -> None:
        if self._channels.pop(source, None) is not None:
            if source in self._selector.get_map():
                self._selector.unregister(source)
            channel.close()


def _sender(connection: socket.socket) -> Callable[[bytes], int]:
    return lambda data: connection.send(data, WITHOUT_SIGNAL)


def _ender(connection: socket.socket, shell: GpasciiShell) -> Callable[[], None]:
    def end() -> None:
        shell.end()
        connection.close()

    return end
