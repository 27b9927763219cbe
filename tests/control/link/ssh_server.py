# SPDX-License-Identifier: LGPL-2.1-or-later
"""A server for ssh on the loopback of this computer, with a simulated Power PMAC behind its shells."""

import contextlib
import socket
import threading

import paramiko
from gpascii import Shell

USER, PASSWORD = "engineer", "not the factory's"


class Server:
    """Listens until it is closed.

    Attributes:
        shell: the controller; all log-ins come to it.
        key: its host key.
        tried: how users wanted to be let in.
        number: of its TCP port.
        user_key: public key that is let in, if any.
        is_mute: whether it takes connections and says nothing.
    """

    def __init__(self):
        self.shell, self.key = Shell(), paramiko.ECDSAKey.generate()
        self.tried, self.user_key, self.is_mute = [], None, False
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._open, self._threads = [self._listener], []
        self.number = self._listener.getsockname()[1]
        self._start(self._accept)

    def known_hosts(self, file, key=None):
        key = key or self.key
        file.write_text(f"[127.0.0.1]:{self.number} {key.get_name()} {key.get_base64()}\n")
        return file

    def cut(self):
        """Cut the connections that there are."""
        for transport in self._open[1:]:
            transport.close()
        del self._open[1:]

    def close(self):
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        self.cut()
        for thread in self._threads:
            thread.join(10)

    def _start(self, work, *arguments):
        thread = threading.Thread(target=work, args=arguments)
        thread.start()
        self._threads.append(thread)

    def _accept(self):
        while True:
            try:
                connection, _ = self._listener.accept()
            except OSError:
                return
            if self.is_mute:
                self._open.append(connection)
                continue
            transport = paramiko.Transport(connection)
            transport.add_server_key(self.key)
            self._open.append(transport)
            with contextlib.suppress(paramiko.SSHException, EOFError):
                transport.start_server(event=threading.Event(), server=Guard(self))
                self._start(self._serve, transport)

    def _serve(self, transport):
        channel = None
        while channel is None:
            if not transport.is_active():
                return
            channel = transport.accept(0.1)
        with contextlib.suppress(OSError):
            channel.sendall(self.shell.greeting())
            while data := channel.recv(1024):
                channel.sendall(self.shell.receive(data))


class Guard(paramiko.ServerInterface):
    """Who is let in, and to what."""

    def __init__(self, server):
        self._server = server

    def get_allowed_auths(self, username):
        return "password,publickey"

    def check_auth_password(self, username, password):
        self._server.tried.append("password")
        is_right = (username, password) == (USER, PASSWORD)
        return paramiko.AUTH_SUCCESSFUL if is_right else paramiko.AUTH_FAILED

    def check_auth_publickey(self, username, key):
        self._server.tried.append("publickey")
        is_right = username == USER and key == self._server.user_key
        return paramiko.AUTH_SUCCESSFUL if is_right else paramiko.AUTH_FAILED

    def check_channel_request(self, kind, number):
        return paramiko.OPEN_SUCCEEDED

    def check_channel_pty_request(self, channel, term, width, height, *pixels):
        return True

    def check_channel_shell_request(self, channel):
        return True
