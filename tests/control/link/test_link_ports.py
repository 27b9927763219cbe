# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of ports, and links of this computer: loopback and pseudo terminals."""

import os
import signal
import socket
import subprocess
import sys
import time
import tty
from pathlib import Path

import pytest
from interpreter import PYTHON

from pkm_post.cli import main
from pkm_post.control.link.errors import LinkLostError
from pkm_post.control.link.ports import Port, port_named
from pkm_post.system import packages


@pytest.mark.parametrize(
    ("name", "port"),
    [
        ("serial:/dev/ttyUSB0", Port("serial", "/dev/ttyUSB0")),
        ("serial:COM3", Port("serial", "COM3")),
        ("tcp:192.6.94.5", Port("tcp", "192.6.94.5", 1025)),
        ("tcp:pmac.local:2000", Port("tcp", "pmac.local", 2000)),
        ("tcp:[::1]:2000", Port("tcp", "::1", 2000)),
        ("ssh:root@192.168.0.200", Port("ssh", "192.168.0.200", 22, user="root")),
        ("ssh:me@[::1]:2222", Port("ssh", "::1", 2222, user="me")),
    ],
)
def test_names(name, port):
    assert port_named(name) == port


@pytest.mark.parametrize(
    "name", ["", "tcp:", "tcp:host:0", "tcp:host:65536", "usb:1", "ssh:host", "ssh:@host", "ssh:me@", "host"]
)
def test_other_names(name):
    with pytest.raises(ValueError, match="expected"):
        port_named(name)


@pytest.fixture
def listener():
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server


def test_tcp_carries_bytes_and_tells_the_end(listener):
    link = Port("tcp", "127.0.0.1", listener.getsockname()[1]).link()
    with pytest.raises(LinkLostError, match="not connected"):
        link.read(0.01)
    link.restart()
    peer, _ = listener.accept()
    link.write(b"ver")
    assert peer.recv(10) == b"ver"
    peer.sendall(b"1.945\r\x06")
    assert link.read(1.0) == b"1.945\r\x06"
    before = time.monotonic()
    assert link.read(0.05) == b"" and time.monotonic() - before < 5
    peer.close()
    with pytest.raises(LinkLostError, match="closed the connection"):
        link.read(1.0)
    link.close()
    link.close()


def test_a_name_that_no_name_server_can_be_asked_for():
    with pytest.raises(LinkLostError, match="aaa, port 1025"):
        Port("tcp", "a" * 70, 1025).link().restart()


def test_nobody_listens(listener):
    number = listener.getsockname()[1]
    listener.close()
    with pytest.raises(LinkLostError, match=str(number)):
        Port("tcp", "127.0.0.1", number).link().restart()


def test_writing_to_a_closed_socket_does_not_end_the_process():
    """With SIGPIPE as FreeCAD leaves it: at its default, which ends the process."""
    code = """
import signal, socket, time
signal.signal(signal.SIGPIPE, signal.SIG_DFL)
from pkm_post.cli import main
from pkm_post.control.link.errors import LinkLostError
from pkm_post.control.link.ports import Port
with socket.create_server(("127.0.0.1", 0)) as server:
    link = Port("tcp", "127.0.0.1", server.getsockname()[1]).link()
    link.restart()
    server.accept()[0].close()
    try:
        for _ in range(1000):
            link.write(bytes(1000))
    except LinkLostError:
        print("lost")
"""
    root = Path(__file__).parents[3]
    reported = subprocess.run(
        [PYTHON, "-c", code], env=os.environ | {"PYTHONPATH": str(root)}, capture_output=True, text=True, timeout=60
    )
    assert reported.returncode != -signal.SIGPIPE
    assert reported.stdout == "lost\n", reported.stderr


@pytest.fixture
def terminal():
    ours, theirs = os.openpty()
    tty.setraw(theirs)
    yield ours, os.ttyname(theirs)
    for end in (ours, theirs):
        os.close(end)


def test_a_serial_line_carries_bytes(terminal):
    ours, name = terminal
    link = Port("serial", name).link()
    link.restart()
    link.write(b"P1\x0e")
    assert os.read(ours, 10) == b"P1\x0e"
    os.write(ours, b"\x81")
    assert link.read(1.0) == b"\x81"
    assert link.read(0.02) == b""
    os.write(ours, b"stale")
    time.sleep(0.05)
    link.restart()
    assert link.read(0.02) == b""
    link.close()
    with pytest.raises(LinkLostError, match="not open"):
        link.write(b"P1")


def test_a_serial_line_that_is_not_there():
    with pytest.raises(LinkLostError, match="/dev/nothing"):
        Port("serial", "/dev/nothing").link().restart()


def test_a_serial_line_that_is_pulled_out():
    ours, theirs = os.openpty()
    tty.setraw(theirs)
    link = Port("serial", os.ttyname(theirs)).link()
    link.restart()
    os.close(ours)
    os.close(theirs)
    with pytest.raises(LinkLostError):
        for _ in range(3):
            link.read(0.05)
            link.write(b"P1")


def test_without_pyserial_it_is_said_what_to_install(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "serial", None)
    assert main(["pmac", "probe", "--port", "serial:/dev/nothing"]) == 1
    assert packages.cure("serial") in capsys.readouterr().err


def test_without_paramiko_it_is_said_what_to_install(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "paramiko", None)
    assert main(["pmac", "probe", "--port", "ssh:me@127.0.0.1"]) == 1
    assert packages.cure("paramiko") in capsys.readouterr().err


def test_what_a_power_pmac_does_not_have_is_refused_by_name(capsys):
    assert main(["pmac", "stream", "--port", "ssh:me@127.0.0.1:1", "--machine", "example_6tps", "none.pmc"]) == 1
    why = "it is for the rotary buffer of a Turbo PMAC"
    assert f"stream is not for a Power PMAC: {why}; use run or play" in capsys.readouterr().err
