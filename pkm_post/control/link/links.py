# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links: carry bytes between this computer and a controller. This is the package's only import of pyserial.

Input and output: bytes. Reads and writes have deadlines; a lost link raises ``LinkLostError``.
"""

from __future__ import annotations

import abc
import errno
import socket
from typing import TYPE_CHECKING, Any, Protocol

from pkm_post.control.link.errors import LinkLostError
from pkm_post.model import Phrase
from pkm_post.options import PARITIES
from pkm_post.system import packages, reason_of

if TYPE_CHECKING:
    import serial

# FreeCAD leaves SIGPIPE at its default: writing to a socket closed by the peer would end the process.
NO_SIGPIPE = getattr(socket, "MSG_NOSIGNAL", 0)
CHUNK = 1 << 16


class Link(Protocol):
    """A connection that carries bytes."""

    def read(self, timeout: float) -> bytes:
        """Received bytes; empty if nothing arrives within ``timeout`` seconds.

        Raises:
            LinkLostError: the link is cut.
        """

    def write(self, data: bytes) -> None:
        """Send bytes.

        Raises:
            LinkLostError: the link is cut, or accepts no bytes.
        """

    def restart(self) -> None:
        """Reconnect if that makes sense, and discard received bytes.

        Raises:
            LinkLostError: reconnecting failed.
        """

    def close(self) -> None:
        """Close it; may be called repeatedly."""


def lost_link(peer: str, fault: Exception, port: int | None = None) -> LinkLostError:
    """The error of a link that the operating system cut or did not open, in plain words."""
    reason = reason_of(fault)
    if isinstance(fault, socket.gaierror):
        reason = Phrase("no computer of this name is known")
    elif isinstance(fault, ConnectionRefusedError):
        reason = Phrase("the connection is refused")
    elif isinstance(fault, TimeoutError):
        reason = Phrase("there is no answer")
    elif isinstance(fault, OSError) and fault.errno == errno.ENOENT:
        reason = Phrase("there is no such port")
    if port is None:
        return LinkLostError(Phrase("{peer}: {reason}", peer=peer, reason=reason))
    return LinkLostError(Phrase("{peer}, port {port}: {reason}", peer=peer, port=port, reason=reason))


class SocketLink(abc.ABC):
    """The common base of network links.

    Attributes:
        number: of the TCP port.
        timeout: seconds to connect, and to send.
    """

    def __init__(self, host: str, number: int, timeout: float) -> None:
        self.host, self.number, self.timeout = host, number, timeout

    @abc.abstractmethod
    def connection(self) -> Any:
        """The open connection: a socket, or an object that behaves like one.

        Raises:
            LinkLostError: it is not connected.
        """

    def read(self, timeout: float) -> bytes:
        """As ``Link``."""
        connection = self.connection()
        connection.settimeout(max(timeout, 1e-3))
        try:
            data = bytes(connection.recv(CHUNK))
        except TimeoutError:
            return b""
        except (OSError, EOFError) as fault:  # paramiko: a peer that disconnects raises EOFError
            raise lost_link(self.host, fault) from fault
        if not data:
            raise LinkLostError(f"{self.host} closed the connection")
        return data

    def write(self, data: bytes) -> None:
        """As ``Link``."""
        connection = self.connection()
        connection.settimeout(self.timeout)
        try:
            self.send_all(connection, data)
        except (OSError, EOFError) as fault:
            raise lost_link(self.host, fault) from fault

    def send_all(self, connection: Any, data: bytes) -> None:
        """Send every byte."""
        connection.sendall(data)


class TcpLink(SocketLink):
    """A TCP connection."""

    def __init__(self, host: str, number: int, timeout: float) -> None:
        super().__init__(host, number, timeout)
        self._socket: socket.socket | None = None

    def send_all(self, connection: socket.socket, data: bytes) -> None:
        """Send every byte; a disconnected peer raises an exception, not a signal."""
        connection.sendall(data, NO_SIGPIPE)

    def restart(self) -> None:
        """As ``Link``."""
        self.close()
        try:
            self._socket = socket.create_connection((self.host, self.number), self.timeout)
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        except (OSError, UnicodeError) as fault:  # a name that cannot be encoded for DNS
            raise lost_link(self.host, fault, self.number) from fault

    def close(self) -> None:
        """As ``Link``."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def connection(self) -> socket.socket:
        """As ``SocketLink``."""
        if self._socket is None:
            raise LinkLostError(f"{self.host} is not connected")
        return self._socket


class SerialLink:
    """A serial line."""

    def __init__(self, device: str, baud: int, parity: str, handshake: bool, timeout: float) -> None:
        """Create a link, not yet open.

        Args:
            baud: bits per second.
            parity: a key of ``options.PARITIES``.
            handshake: whether the line has RTS and CTS.
            timeout: seconds to send.
        """
        self._device, self._baud, self._parity = device, baud, PARITIES[parity]
        self._handshake, self._timeout = handshake, timeout
        self._line: serial.Serial | None = None

    def read(self, timeout: float) -> bytes:
        """As ``Link``."""
        line = self._open_line()
        try:
            line.timeout = max(timeout, 1e-3)
            first = line.read(1)
            return first + line.read(line.in_waiting) if first else b""
        except (OSError, TypeError) as fault:  # pyserial: a line closed meanwhile raises TypeError
            raise self._lost(fault) from fault

    def write(self, data: bytes) -> None:
        """As ``Link``."""
        line = self._open_line()
        try:
            line.write(data)
        except OSError as fault:
            raise self._lost(fault) from fault

    def restart(self) -> None:
        """As ``Link``; the line is reopened only after it was lost."""
        try:
            if self._line is None:
                self._line = self._opened()
            self._line.reset_input_buffer()
        except (OSError, _terminal_error()) as fault:
            raise self._lost(fault) from fault

    def close(self) -> None:
        """As ``Link``."""
        if self._line is not None:
            self._line.close()
            self._line = None

    def _open_line(self) -> serial.Serial:
        if self._line is None:
            raise LinkLostError(f"{self._device} is not open")
        return self._line

    def _lost(self, fault: Exception) -> LinkLostError:
        self.close()
        return lost_link(self._device, fault)

    def _opened(self) -> serial.Serial:
        """Open the line.

        Raises:
            ImportError: pyserial is not installed.
            OSError: the line does not exist, or is in use.
        """
        try:
            import serial
        except ImportError as missing:
            raise packages.needs("a serial line needs", "serial") from missing
        return serial.Serial(
            self._device,
            self._baud,
            parity=self._parity,
            rtscts=self._handshake,
            write_timeout=self._timeout,
            exclusive=True,
        )


def _terminal_error() -> type[Exception]:
    """The exception of the system for a lost line; OSError on Windows."""
    try:
        import termios
    except ImportError:
        return OSError
    return termios.error
