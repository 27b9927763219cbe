# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ssh on the loopback of this computer: who is trusted, who is let in, what a cut does."""

import time

import paramiko
import pytest
from ssh_server import PASSWORD, USER, Server

from pkm_post.cli import main
from pkm_post.control.link import ssh_link
from pkm_post.control.link.errors import LinkLostError, NoAccessError
from pkm_post.control.link.ports import Port
from pkm_post.control.link.session import Session


@pytest.fixture
def server(monkeypatch, tmp_path):
    """A server, and a user who has no keys and no agent."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("SSH_AUTH_SOCK", raising=False)
    monkeypatch.delenv(ssh_link.PASSWORD, raising=False)
    monkeypatch.setattr("sys.stdin.isatty", lambda: False, raising=False)
    made = Server()
    yield made
    made.close()


@pytest.fixture
def port(server, tmp_path):
    known = server.known_hosts(tmp_path / "known_hosts")
    return Port("ssh", "127.0.0.1", server.number, user=USER, known_hosts=known)


def test_a_session_with_a_password_of_the_environment(server, port, monkeypatch):
    monkeypatch.setenv(ssh_link.PASSWORD, PASSWORD)
    with Session(port) as session:
        assert session.query("cid") == ("604020",)
    assert server.shell.said[0] == "echo 7"


def test_a_session_with_a_key(server, port, tmp_path):
    key = paramiko.ECDSAKey.generate()
    (tmp_path / ".ssh").mkdir()
    key.write_private_key_file(str(tmp_path / ".ssh" / "id_ecdsa"))
    server.user_key = key
    with Session(port) as session:
        assert session.query("cid") == ("604020",)
    assert set(server.tried) == {"publickey"}


def test_a_user_is_asked_once_for_his_password(server, port, monkeypatch):
    asked = []
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    monkeypatch.setattr("getpass.getpass", lambda prompt: asked.append(prompt) or PASSWORD)
    with Session(port, pause=0.01) as session:
        server.cut()
        assert session.query("cid") == ("604020",)  # asked again in a new shell
    assert asked == ["password of engineer at 127.0.0.1: "]


@pytest.mark.parametrize("password", [None, "deltatau"])
def test_a_user_who_is_not_let_in_is_not_tried_again(server, port, monkeypatch, password):
    if password:
        monkeypatch.setenv(ssh_link.PASSWORD, password)
    with pytest.raises(NoAccessError, match="error C218: .*a key,? .*or the password in PKM_PMAC_PASSWORD"):
        Session(port).open()
    assert server.tried == ["password"] * bool(password)


def test_an_unknown_host_key_is_refused_before_a_password_is_sent(server, port, monkeypatch, tmp_path):
    monkeypatch.setenv(ssh_link.PASSWORD, PASSWORD)
    port.known_hosts.write_text("")
    with pytest.raises(NoAccessError, match="error C217: .*not among the known ones, ecdsa-sha2-nistp256 SHA256:"):
        Session(port).open()
    assert server.tried == [] and port.known_hosts.read_text() == ""


def test_a_host_key_that_has_changed_is_refused(server, port, monkeypatch):
    monkeypatch.setenv(ssh_link.PASSWORD, PASSWORD)
    server.known_hosts(port.known_hosts, paramiko.ECDSAKey.generate())
    with pytest.raises(NoAccessError, match="error C217: .*IS NOT WHO IT WAS"):
        Session(port).open()
    assert server.tried == []


def test_a_file_of_host_keys_that_is_not_there(port, tmp_path):
    link = ssh_link.SshLink("127.0.0.1", port.number, USER, tmp_path / "none", 1.0)
    with pytest.raises(NoAccessError, match="error C215: .*No such file"):
        link.restart()


@pytest.mark.parametrize("named", [True, False])
@pytest.mark.parametrize(
    "line",
    [
        b"\xff\xfe\x00",
        b"a b c d e f",
        b"host ssh-rsa AAAAB3NzaC1yc2E=",
        b"|1|bad ssh-ed25519 AAAAC3NzaC1lZDI1NTE5AAAAI",
        b"|1|a|b ssh-ed25519 AAAAC3NzaC1lZDI1NTE5AAAAIJdD7y3aLq454yWBdwLWbieU1ebz9/cu7/QEXn9OIeZJ",
    ],
)
def test_a_file_of_host_keys_that_is_damaged_is_named_with_its_line(server, port, tmp_path, line, named, capsys):
    file = port.known_hosts if named else tmp_path / ".ssh" / "known_hosts"
    file.parent.mkdir(exist_ok=True)
    file.write_bytes(server.known_hosts(tmp_path / "good").read_bytes() + line + b"\n")
    name = f"ssh:{USER}@127.0.0.1:{server.number}"
    arguments = ["--known-hosts", str(file)] if named else []
    assert main(["pmac", "probe", "--port", name, *arguments]) == 1
    reported = capsys.readouterr().err
    assert f"{file}: " in reported and "error C215: the file with the known host keys cannot be read" in reported
    assert "line 2: error" in reported or line.startswith(b"|1|a|b")
    assert server.tried == []


def test_a_link_that_is_cut(server, port, monkeypatch):
    monkeypatch.setenv(ssh_link.PASSWORD, PASSWORD)
    link = port.link()
    with pytest.raises(LinkLostError, match="not connected"):
        link.read(0.01)
    link.restart()
    before = time.monotonic()
    while link.read(0.2):
        pass
    assert time.monotonic() - before < 10
    server.cut()
    with pytest.raises(LinkLostError):
        for _ in range(100):
            link.read(0.05)
            link.write(b"cid\n")
    link.close()
    link.close()


def test_a_computer_that_takes_connections_and_says_nothing(server, port):
    server.is_mute = True
    link = ssh_link.SshLink("127.0.0.1", port.number, USER, port.known_hosts, 0.3)
    with pytest.raises(LinkLostError):
        link.restart()


def test_nobody_listens(server, port):
    server.close()
    with pytest.raises(LinkLostError, match=str(port.number)):
        port.link().restart()


def test_the_commands(server, port, monkeypatch, capsys):
    monkeypatch.setenv(ssh_link.PASSWORD, PASSWORD)

    def pmac(action, *arguments):
        name = f"ssh:{USER}@127.0.0.1:{server.number}"
        return main(["pmac", action, "--port", name, "--known-hosts", str(port.known_hosts), *arguments])

    assert pmac("probe") == 0
    assert capsys.readouterr().out.startswith("CID: 604020\nSys.MaxCoords: 16\n")
    assert pmac("stream", "--machine", "example_6tps", "none.pmc") == 1
    assert "stream is not for a Power PMAC" in capsys.readouterr().err
    assert not any("r" in line for line in server.shell.said if line.startswith("&"))
