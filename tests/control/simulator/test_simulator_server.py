# SPDX-License-Identifier: LGPL-2.1-or-later
"""The doors: a TCP port of this computer, a pseudo terminal. Every wait has an end."""

import os
import re
import select
import signal
import socket
import struct
import subprocess
import threading
import time

import pytest
from interpreter import PYTHON

from pkm_post.cli import main
from pkm_post.control.simulator import Controller, Server
from pkm_post.control.simulator import server as serve

DEADLINE_S = 120.0


@pytest.fixture
def serving():
    """A server that runs in a thread until the test is over, and its controller's time runs 20 times as fast."""
    server, over = Server(Controller(), speed=20.0), threading.Event()
    thread = threading.Thread(target=server.run, args=(over.is_set,))
    started = []

    def start():
        thread.start()
        started.append(True)

    yield server, start
    over.set()
    if started:
        thread.join(DEADLINE_S)
    server.close()
    assert not thread.is_alive()


def connected(port):
    return socket.create_connection(("127.0.0.1", port), timeout=DEADLINE_S)


def ask(connection, text):
    connection.sendall(struct.pack(">BBHHH", 0x40, 0xBF, 0, 0, len(text)) + text.encode())
    return connection.recv(2048)


def read_until(device, end):
    """Bytes of a device up to an end; what came until the deadline when it does not come."""
    data, last = b"", time.monotonic() + DEADLINE_S
    while not data.endswith(end) and time.monotonic() < last:
        if select.select([device], [], [], 0.1)[0]:
            data += os.read(device, 4096)
    return data


def test_tcp(serving):
    server, start = serving
    port = server.add_tcp(0)
    start()
    with connected(port) as connection:
        assert ask(connection, "I3=2 I6=1 VER") == b"1.947\r\x06"
        assert ask(connection, "#1J/ J=1000") == b"\x06"
        last = time.monotonic() + DEADLINE_S
        while ask(connection, "#1P") != b"1000\r\x06":
            assert time.monotonic() < last


def test_a_link_that_is_cut_in_a_packet_does_no_harm_to_the_next(serving):
    server, start = serving
    port = server.add_tcp(0)
    start()
    for cut in range(1, 14):
        with connected(port) as connection:
            connection.sendall((struct.pack(">BBHHH", 0x40, 0xBF, 0, 0, 6) + b"P1=123")[:cut])
    with connected(port) as connection:
        assert ask(connection, "I3=2 P2=5") == b"\x06"
        assert ask(connection, "P2") == b"5\r\x06"


def test_a_client_that_does_not_read_does_not_stop_the_others(serving):
    server, start = serving
    port = server.add_tcp(0)
    start()
    with connected(port) as deaf, connected(port) as other:
        request = struct.pack(">BBHHH", 0x40, 0xBF, 0, 0, 7) + b"P0..999"
        deaf.setblocking(False)
        try:
            for _ in range(500):
                deaf.send(request)
        except BlockingIOError:
            pass  # its own buffers are full, as they should be
        assert ask(other, "I3=2 P2=5") == b"\x06"


def test_a_client_that_says_much_and_never_reads_is_not_listened_to_any_more(serving, monkeypatch):
    monkeypatch.setattr(serve, "MOST_UNSENT", 1 << 14)
    server, start = serving
    create = socket.create_server

    def with_little_room(address):
        listener = create(address)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 14)
        return listener

    monkeypatch.setattr("socket.create_server", with_little_room)
    port = server.add_tcp(0)
    start()
    request, over, turns = struct.pack(">BBHHH", 0x40, 0xBF, 0, 0, 7) + b"P0..699", threading.Event(), []

    def talk(deaf):
        while not over.is_set():
            try:
                turns.append(deaf.send(100 * request))
            except TimeoutError:
                turns.append(0)

    with connected(port) as deaf, connected(port) as other:
        deaf.settimeout(0.05)
        talker = threading.Thread(target=talk, args=(deaf,))
        talker.start()
        try:
            last = time.monotonic() + DEADLINE_S
            while all(channel.is_heard for channel in list(server._channels.values())) or 0 not in turns:
                assert ask(other, "I3=2 P2=5") == b"\x06" and time.monotonic() < last
            for _ in range(10):
                assert ask(other, "P2") == b"5\r\x06"
        finally:
            over.set()
            talker.join(DEADLINE_S)
        unsent = max(len(channel.unsent) for channel in server._channels.values())
        assert unsent < serve.MOST_UNSENT + serve.MORSEL * 1400


def test_a_server_without_file_descriptors_goes_on_and_takes_clients_again():
    limit = "import resource, sys; resource.setrlimit(resource.RLIMIT_NOFILE, (16, 16))"
    code = f"{limit}; from pkm_post.cli import main; sys.exit(main(['pmac', 'simulate', '--tcp', '0']))"
    with subprocess.Popen([PYTHON, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as child:
        try:
            port = int(re.search(rb"tcp:127.0.0.1:(\d+)", child.stdout.readline())[1])
            clients = [connected(port) for _ in range(30)]
            assert ask(clients[0], "I3=2 P2=5") == b"\x06"
            waiting = clients.pop()
            waiting.sendall(struct.pack(">BBHHH", 0x40, 0xBF, 0, 0, 2) + b"P2")
            assert ask(clients[0], "P2") == b"5\r\x06"
            for client in clients:
                client.close()
            assert waiting.recv(2048) == b"5\r\x06"
            waiting.close()
        finally:
            child.send_signal(signal.SIGINT)
            _, reported = child.communicate(timeout=DEADLINE_S)
    assert child.returncode == 0 and reported == b""


def test_no_descriptor_at_all_is_reported(capsys, monkeypatch):
    def none_left():
        raise OSError(24, "Too many open files")

    monkeypatch.setattr("selectors.DefaultSelector", none_left)
    assert main(["pmac", "simulate", "--tcp", "0"]) == 1
    assert "no connection can be offered: [Errno 24]" in capsys.readouterr().err


def test_time_that_the_computer_cannot_keep_up_with_keeps_no_client_waiting():
    controller, lapses, over = Controller(), [], threading.Event()

    def advance(ms):
        lapses.append(ms)
        time.sleep(0.01)  # far slower than the time that is asked for

    controller.advance = advance
    server = Server(controller, speed=1e6)
    port = server.add_tcp(0)
    thread = threading.Thread(target=server.run, args=(over.is_set,))
    thread.start()
    try:
        with connected(port) as connection:
            before = len(lapses)
            assert ask(connection, "I3=2 P2=5") == b"\x06"
            # one turn until the request is seen and one on the way, of two or three lapses each
            assert len(lapses) - before < 20
    finally:
        over.set()
        thread.join(DEADLINE_S)
        server.close()


def test_a_port_that_is_taken_is_reported(serving):
    server, start = serving
    port = server.add_tcp(0)
    start()
    second = Server(Controller())
    with pytest.raises(OSError, match="in use"):
        second.add_tcp(port)
    second.close()


def test_pty(serving):
    server, start = serving
    path = server.add_pty()
    start()
    device = os.open(path, os.O_RDWR | os.O_NOCTTY)
    try:
        os.write(device, b"I3=2 I6=1 I64=1\r")
        assert read_until(device, b"\x06") == b"\x06"
        for line in (b"OPEN PROG 1", b"CLEAR", b'SEND"hello"', b"CLOSE", b"#1->X", b"#1J/", b"B1R"):
            os.write(device, line + b"\r")
        assert read_until(device, b"hello\r") == b"\x06" * 7 + b"\x02hello\r"
    finally:
        os.close(device)
    again = os.open(path, os.O_RDWR | os.O_NOCTTY)
    try:
        os.write(again, b"LIST PROG 1\r")
        assert read_until(again, b"\x06") == b'SEND"hello"\rRET\r\x06'
    finally:
        os.close(again)


def test_a_long_answer_goes_through_a_pty_in_pieces(serving):
    server, start = serving
    path = server.add_pty()
    start()
    device = os.open(path, os.O_RDWR | os.O_NOCTTY)
    try:
        os.write(device, b"I3=2\r")
        read_until(device, b"\x06")
        os.write(device, b"P0..8191=1.25\r")
        read_until(device, b"\x06")
        os.write(device, b"P0..8191\r")
        assert read_until(device, b"\x06") == b"1.25\r" * 8192 + b"\x06"
    finally:
        os.close(device)
