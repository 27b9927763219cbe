# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ssh server: log-ins to the computer of a simulated Power PMAC, from this computer only.

Each log-in gets a shell. Its bytes go through a pair of sockets to the one thread that serves the controller, so access
to the controller is serialized. Silent clients and failing log-ins are disconnected after a timeout.

Input and output: bytes. paramiko is passed in by its only importer.
"""

from __future__ import annotations

import contextlib
import hmac
import logging
import socket
import threading
import time
from collections.abc import Callable
from types import ModuleType
from typing import Any

LOOPBACK = "127.0.0.1"
LOG_IN_S = 10.0
"""Seconds for a log-in and for its shell."""
MOST_LOG_INS = 32
_LOG = logging.getLogger("pkm_post.simulator.ssh")
_LOG.setLevel(logging.CRITICAL)  # a failed log-in is the client's problem
_POLL_S = 0.1
_PIECE = 4096

Attach = Callable[[socket.socket], None]
"""Takes our end of the pair of sockets of a new shell."""


class SshServer:
    """Listens until it is closed.

    Attributes:
        number: of its TCP port.
        user: user allowed to log in.
        host_key: name and text of its public key, as in a file of known hosts.
    """

    user = "root"

    def __init__(self, ssh: ModuleType, port: int, password: str, attach: Attach) -> None:
        """Start listening.

        Args:
            ssh: paramiko.
            port: number of the TCP port; 0 takes a free one.
            attach: called in another thread for each new shell.

        Raises:
            OSError: the port is taken.
        """
        self._ssh, self._password, self._attach = ssh, password, attach
        self._key = ssh.ECDSAKey.generate()
        self._listener = socket.create_server((LOOPBACK, port))
        self._listener.settimeout(_POLL_S)
        self.number = int(self._listener.getsockname()[1])
        self.host_key = f"{self._key.get_name()} {self._key.get_base64()}"
        self._is_closed = threading.Event()
        self._threads: list[threading.Thread] = []
        self._start(self._accept)

    @property
    def known_host(self) -> str:
        """The line for a file of known hosts."""
        return f"[{LOOPBACK}]:{self.number} {self.host_key}"

    def close(self) -> None:
        """End all log-ins, and wait for their threads."""
        self._is_closed.set()
        for thread in list(self._threads):
            thread.join(LOG_IN_S)
        self._listener.close()

    def _start(self, work: Callable[..., None], *arguments: Any) -> None:
        self._threads = [thread for thread in self._threads if thread.is_alive()]
        thread = threading.Thread(target=work, args=arguments, daemon=True)
        self._threads.append(thread)
        thread.start()

    def _accept(self) -> None:
        while not self._is_closed.is_set():
            try:
                connection, _ = self._listener.accept()
            except TimeoutError:
                continue
            except OSError:
                return
            if len(self._threads) > MOST_LOG_INS:
                connection.close()
                continue
            self._start(self._log_in, connection)

    def _log_in(self, connection: socket.socket) -> None:
        """Serve one connection until either side ends it."""
        transport = self._ssh.Transport(connection)
        transport.set_log_channel(_LOG.name)
        transport.banner_timeout = transport.auth_timeout = LOG_IN_S
        transport.add_server_key(self._key)
        try:
            transport.start_server(event=threading.Event(), server=_guard(self._ssh, self._password))
            channel = self._shell_of(transport)
            if channel is not None:
                self._serve(channel)
        except (self._ssh.SSHException, EOFError, OSError):
            return  # the peer is gone, or speaks something else
        finally:
            transport.close()

    def _shell_of(self, transport: Any) -> Any:
        """The channel of the shell; None if none was requested in time."""
        until = time.monotonic() + LOG_IN_S
        while transport.is_active() and time.monotonic() < until and not self._is_closed.is_set():
            channel = transport.accept(_POLL_S)
            if channel is not None:
                return channel
        return None

    def _serve(self, channel: Any) -> None:
        ours, theirs = socket.socketpair()
        self._attach(theirs)
        self._start(self._bring_back, ours, channel)
        channel.settimeout(_POLL_S)
        with ours:
            while not self._is_closed.is_set():
                try:
                    data = channel.recv(_PIECE)
                except TimeoutError:
                    continue
                if not data:
                    return
                ours.sendall(data)

    def _bring_back(self, ours: socket.socket, channel: Any) -> None:
        """Send bytes of the shell to the client, until the shell ends."""
        with contextlib.suppress(OSError, EOFError):  # the client is gone
            while data := ours.recv(_PIECE):
                channel.sendall(data)
            channel.close()


def _guard(ssh: ModuleType, password: str) -> Any:

    class Guard(ssh.ServerInterface):  # type: ignore[misc,name-defined]
        def get_allowed_auths(self, username: str) -> str:
            return "password"

        def check_auth_password(self, username: str, offered: str) -> int:
            is_right = username == SshServer.user and hmac.compare_digest(offered.encode(), password.encode())
            return int(ssh.AUTH_SUCCESSFUL if is_right else ssh.AUTH_FAILED)

        def check_channel_request(self, kind: str, chanid: int) -> int:
            return int(ssh.OPEN_SUCCEEDED if kind == "session" else ssh.OPEN_FAILED_ADMINISTRATIVELY_PROHIBITED)

        def check_channel_pty_request(self, *arguments: Any) -> bool:
            return True

        def check_channel_shell_request(self, channel: Any) -> bool:
            return True

    return Guard()
