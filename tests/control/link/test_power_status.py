# SPDX-License-Identifier: LGPL-2.1-or-later
"""A session with a simulated Power PMAC: state, stops and errors."""

import itertools

import numpy as np
import pytest
from controller_settings import settings_for
from gpascii import CLOSED_LOOP, READY, Shell, ShellLink

from pkm_post.control.link import stopping
from pkm_post.control.link.errors import LinkLostError, OutcomeUnknownError, RefusedError
from pkm_post.control.link.gpascii_protocol import GpasciiProtocol
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import is_busy, read_status
from pkm_post.control.link.tool_pose import state_text

SETTINGS = settings_for("power_pmac", counts_per_mm=1000.0)
NANOMETRE = 1e-6


class Port:
    """A door to shells, with a clock that passes when somebody waits."""

    silence, now, name = 0.1, 0.0, ""

    def __init__(self, *shells):
        self.shells = iter(shells) if len(shells) > 1 else itertools.repeat(shells[0])

    def link(self):
        return ShellLink(self.shells, self)

    def protocol(self):
        return GpasciiProtocol(self.silence)

    def sleep(self, seconds):
        self.now += seconds

    def session(self):
        return Session(self, 0.5, 0.1, clock=lambda: self.now, sleep=self.sleep)


@pytest.fixture
def shell():
    return Shell()


@pytest.fixture
def session(shell):
    with Port(shell).session() as session:
        yield session


def test_struts_are_reported_in_mm(shell, session):
    shell.positions = [1000.0 * strut for strut in range(6)]
    status = read_status(session, SETTINGS)
    assert np.allclose(status.length, 500.0 + np.arange(6), atol=NANOMETRE)
    assert np.allclose(status.following_error, 0.0005, atol=NANOMETRE)
    assert status.fault_texts() == () and status.standing and not status.running and all(status.homed)
    assert "no program runs, override 100 %" in state_text(status)


@pytest.mark.parametrize(
    ("bit", "said"),
    [
        (61, "strut 2: on its lower limit"),
        (60, "strut 2: on its upper limit"),
        (58, "strut 2: following error too large, switched off"),
        (56, "strut 2: amplifier fault"),
        (55, "strut 2: on its lower soft limit"),
    ],
)
def test_bits_of_a_motor_in_words(shell, session, bit, said):
    shell.motors[1] |= 1 << bit
    assert read_status(session, SETTINGS).fault_texts() == (said,)


def test_nothing_comes_after_the_query_for_the_override(shell, session):
    """``%`` with a value after it sets the override [Power PMAC User's Manual, p. 695], and blanks do not count."""
    read_status(session, SETTINGS)
    assert shell.said[-1].endswith(" &1%") and shell.said[-1].count("%") == 1


def test_a_motor_that_is_not_in_closed_loop_is_in_open_loop(shell, session):
    shell.motors[4] = READY & ~CLOSED_LOOP
    assert read_status(session, SETTINGS).fault_texts() == ("strut 5: in open loop",)


@pytest.mark.parametrize(("bit", "said"), [(58, "a following error was too large"), (60, "an upper limit was met")])
def test_bits_of_the_coordinate_system_in_words(shell, session, bit, said):
    shell.system = 1 << bit
    assert read_status(session, SETTINGS).fault_texts() == (said,)


def test_a_program_is_held_and_aborted(shell, session):
    shell.elements["coord[1].progrunning"] = 1
    assert read_status(session, SETTINGS).running
    assert stopping.hold(session, SETTINGS).held
    assert not stopping.abort(session, SETTINGS).running
    assert [line for line in shell.said if line[0] == "&"] == ["&1H", "&1H", "&1A"]


@pytest.mark.parametrize(("active", "feed_hold", "running", "held"), [(1, 1, True, True), (1, 3, True, True),
                                                                       (1, 2, True, False), (1, 0, False, False),
                                                                       (0, 1, False, False)])  # fmt: skip
def test_a_held_program_is_active(shell, session, active, feed_hold, running, held):
    """FeedHold and ProgActive as on pages 693 to 695 of the User's Manual, should ProgRunning be 0 in a hold."""
    shell.elements |= {"coord[1].progactive": active, "coord[1].feedhold": feed_hold}
    status = read_status(session, SETTINGS)
    assert (status.running, status.held, is_busy(session)) == (running, held, running)


@pytest.mark.parametrize("acknowledges", [True, False])
def test_a_session_begins_with_and_without_an_ack_at_the_start(acknowledges):
    shell = Shell()
    shell.acknowledges_start = acknowledges
    with Port(shell).session() as session:
        assert session.query("cid") == ("604020",)


@pytest.mark.parametrize("acknowledges", [True, False])
@pytest.mark.parametrize("splits", [True, False])
def test_a_refusal_leaves_the_session_in_step(shell, session, acknowledges, splits):
    shell.acknowledges_refusals, shell.splits = acknowledges, splits
    for _ in range(3):
        with pytest.raises(RefusedError, match="error #20, illegal command") as refused:
            session.command("foo")
        assert refused.value.number == 20
        assert session.query("cid") == ("604020",)


def test_a_query_is_asked_again_in_another_shell_and_a_set_is_not():
    deaf, well = Shell(), Shell()
    with Port(deaf, well, well, well).session() as session:
        deaf.garble = lambda said: said[:5]
        assert session.query("cid") == ("604020",)
        well.garble = lambda said: said[:-4]
        with pytest.raises(OutcomeUnknownError):
            session.command("&1h")
        assert well.said.count("&1h") == 1


def test_a_computer_without_gpascii():
    shell = Shell()
    shell.garble = lambda said: b"sh: gpascii: not found\r\n"
    port = Port(shell)
    with pytest.raises(LinkLostError, match="no controller answers as expected"):
        port.session().open()
    assert port.now < 60


def test_an_answer_that_is_none(shell, session):
    shell.elements["coord[1].progrunning"] = "nan?"
    with pytest.raises(LinkLostError, match="nan"):
        read_status(session, SETTINGS)
