# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ssh link: a shell on a controller's computer. This is the package's only import of paramiko.

No host is trusted on first use: the controller's host key must be known, or nothing is sent to it. A key of the user or
of the ssh agent is tried first, then a password, which is requested and kept for this link only.

Input and output: bytes.
"""

from __future__ import annotations

import getpass
import logging
import os
import socket
import sys
import threading
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from pkm_post.control.link.errors import LinkLostError, NoAccessError
from pkm_post.control.link.links import NO_SIGPIPE, SocketLink, lost_link
from pkm_post.model import Diagnostic, Place
from pkm_post.system import packages

if TYPE_CHECKING:
    import paramiko

PASSWORD = "PKM_PMAC_PASSWORD"
"""Environment variable for the password."""
_LOG = logging.getLogger("pkm_post.paramiko")
_LOG.setLevel(logging.CRITICAL)  # failures are raised as exceptions; the rest is noise
_NOTHING_TO_OFFER = "No authentication methods available"
"""Message by which to recognize paramiko's exception, which has no class of its own."""
_COLUMNS = 1000
"""Width of the terminal: a longer line may be echoed in several pieces."""


class SshLink(SocketLink):
    """A shell over ssh."""

    def __init__(self, host: str, number: int, user: str, known_hosts: Path | None, timeout: float) -> None:
        """Create a link, not yet connected.

        Args:
            number: of the TCP port.
            user: login name.
            known_hosts: file of trusted host keys; the user's own by default.
            timeout: seconds for each step of connecting, and to send.
        """
        super().__init__(host, number, timeout)
        self._user, self._known_hosts = user, known_hosts
        self._password = os.environ.get(PASSWORD)
        self._client: paramiko.SSHClient | None = None
        self._channel: paramiko.Channel | None = None

    def restart(self) -> None:
        """As ``links.Link``; logs in again.

        Raises:
            NoAccessError: the host key is unknown, or the user is denied access.
            ImportError: paramiko is not installed.
        """
        self.close()
        ssh = ssh_package()
        try:
            self._log_in(ssh)
        except ssh.AuthenticationException as fault:
            if not self._asked_password():
                raise self._denied(str(fault)) from fault
            self.restart()
        except ssh.BadHostKeyException as fault:
            raise self._unknown(f"IT IS NOT WHO IT WAS: its host key has changed. {fault}") from fault
        except (OSError, EOFError, ssh.SSHException) as fault:
            if _NOTHING_TO_OFFER in str(fault) and self._asked_password():
                self.restart()
                return
            if _NOTHING_TO_OFFER in str(fault):
                raise self._denied("it wants a key or a password") from fault
            raise lost_link(self.host, fault, self.number) from fault

    def close(self) -> None:
        """As ``links.Link``."""
        if self._client is not None:
            self._client.close()
        self._client = self._channel = None

    def connection(self) -> paramiko.Channel:
        """As ``links.SocketLink``."""
        if self._channel is None:
            raise LinkLostError(f"{self.host} is not connected")
        return self._channel

    def _log_in(self, ssh: ModuleType) -> None:
        """Connect and open a shell, within a deadline."""
        client = self._client = ssh.SSHClient()
        client.set_log_channel(_LOG.name)
        self._trust(client, ssh)
        connection = _Socket(socket.create_connection((self.host, self.number), self.timeout))
        # Some steps of paramiko have no deadline of their own; closing the client ends them.
        deadline = threading.Timer(4 * self.timeout, client.close)
        deadline.start()
        try:
            client.connect(
                self.host, self.number, self._user, self._password, sock=connection,
                timeout=self.timeout, banner_timeout=self.timeout, auth_timeout=self.timeout,
            )  # fmt: skip
            self._channel = client.invoke_shell(term="dumb", width=_COLUMNS)
        except BaseException:
            self.close()
            connection.close()
            raise
        finally:
            deadline.cancel()

    def _trust(self, client: paramiko.SSHClient, ssh: ModuleType) -> None:
        """Make a client trust the known host keys, and no others."""
        unknown = self._unknown

        class Refuse(ssh.MissingHostKeyPolicy):  # type: ignore[misc,name-defined]
            def missing_host_key(self, client: paramiko.SSHClient, name: str, key: paramiko.PKey) -> None:
                raise unknown(f"its host key is not among the known ones, {key.get_name()} {key.fingerprint}")

        client.set_missing_host_key_policy(Refuse())
        file = self._known_hosts or Path("~/.ssh/known_hosts").expanduser()
        try:
            ssh.HostKeys(str(file)).lookup(self.host)  # only a look-up reveals some faulty lines
            client.load_system_host_keys(str(file))
        except OSError as fault:
            if self._known_hosts is not None:
                raise NoAccessError(Diagnostic("C215", Place(str(file)), str(fault.strerror))) from fault
        except (ssh.hostkeys.InvalidHostKey, ssh.SSHException, ValueError) as fault:
            place = Place(str(file), line=_bad_line(file, ssh))
            raise NoAccessError(Diagnostic("C215", place, str(fault))) from fault

    def _denied(self, why: str) -> NoAccessError:
        return NoAccessError(Diagnostic("C218", Place(self.host), f"{self._user}: {why}"))

    def _unknown(self, why: str) -> NoAccessError:
        return NoAccessError(Diagnostic("C217", Place(f"{self.host}, port {self.number}"), why))

    def _asked_password(self) -> bool:
        """Ask the user for a password once; return whether there is one to try."""
        if self._password is not None or not _has_listener():
            return False
        self._password = getpass.getpass(f"password of {self._user} at {self.host}: ")
        return True


def _bad_line(file: Path, ssh: ModuleType) -> int:
    """Number of the first line that is not a host key; 0 if each line is valid by itself."""
    for number, line in enumerate(file.read_bytes().splitlines(), 1):
        try:
            ssh.hostkeys.HostKeyEntry.from_line(line.decode(), number)
        except (ssh.hostkeys.InvalidHostKey, ssh.SSHException, ValueError):
            return number
    return 0


class _Socket(socket.socket):
    """A socket that raises no SIGPIPE, which would end FreeCAD."""

    def __init__(self, connection: socket.socket) -> None:
        timeout = connection.gettimeout()
        super().__init__(fileno=connection.detach())
        self.settimeout(timeout)
        self.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, data: bytes, flags: int = 0) -> int:  # type: ignore[override]
        """As ``socket.socket``."""
        return super().send(data, flags | NO_SIGPIPE)


def _has_listener() -> bool:
    """Whether a user is at a terminal; in a GUI there is none, and its thread would block forever."""
    here = threading.current_thread() is threading.main_thread()
    return here and sys.stdin is not None and sys.stdin.isatty()


def ssh_package() -> ModuleType:
    """Import paramiko.

    Raises:
        ImportError: it is not installed; the text says how to install it.
    """
    try:
        import paramiko
    except ImportError as missing:
        raise packages.needs("ssh needs", "paramiko") from missing
    return paramiko
