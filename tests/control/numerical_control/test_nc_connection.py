# SPDX-License-Identifier: LGPL-2.1-or-later
"""A machine by its names, and a simulated one to train with, over loopback."""

import socket
import time

import pytest
from station import MACHINE, SETTINGS, TOOL

from pkm_post.control.link.errors import LinkLostError
from pkm_post.control.link.ports import Port
from pkm_post.control.numerical_control.connection import (
    SIMULATED_HOMING,
    ConnectionTarget,
    SimulatedMachine,
    connect,
    connection_target,
)
from pkm_post.control.numerical_control.homing import HomingPhase
from pkm_post.control.numerical_control.manual_moves import CartesianJog
from pkm_post.machine import find_machine
from pkm_post.writing import PowerPmacSettings

LONGEST_S = 240.0
FAST = 2.0
"""Simulated seconds in a second; a homing has to be seen by a reading each 0.1 s."""


def until(holds):
    end = time.monotonic() + LONGEST_S
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_names_become_a_target():
    target, reported = connection_target("tcp:127.0.0.1:1025", "example_6tps")
    assert (target.port, reported) == (Port("tcp", "127.0.0.1", 1025), ())
    assert (target.machine.fingerprint, target.settings) == (MACHINE.fingerprint, SETTINGS)


@pytest.fixture
def power_file(tmp_path):
    """The example with a Power PMAC."""
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    file = tmp_path / "power.toml"
    file.write_text(text.replace('kind = "turbo_pmac"', 'kind = "power_pmac"'), encoding="utf-8")
    return str(file)


def test_a_power_pmac_is_at_a_port_with_ssh(power_file):
    target, reported = connection_target("ssh:me@host", power_file)
    assert target.port.is_power and isinstance(target.settings, PowerPmacSettings) and not reported
    other, reported = connection_target("tcp:host", power_file)
    assert other is None and [fault.code for fault in reported] == ["M104"]
    with pytest.raises(ValueError, match="port: expected"):
        connection_target("shell:127.0.0.1:1025", power_file)


def test_what_is_wrong_with_names():
    with pytest.raises(ValueError, match="port: expected"):
        connection_target("usb:1", "example_6tps")
    target, reported = connection_target(None, "no_such_machine")
    assert target is None and [fault.code for fault in reported] == ["M101"]


def test_nobody_answers():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        number = taken.getsockname()[1]
    with pytest.raises(LinkLostError):
        connect(ConnectionTarget(Port("tcp", "127.0.0.1", number, timeout=0.2), MACHINE, SETTINGS), TOOL)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["turbo", "power"])
def test_a_simulated_machine_is_homed_and_jogged(kind, power_file):
    target, _ = connection_target(None, "example_6tps" if kind == "turbo" else power_file)
    connection = connect(target, TOOL, FAST)
    try:
        worker = connection.worker
        until(lambda: worker.state.status is not None)
        assert connection.simulated and not any(worker.state.status.homed) and worker.state.status.fault_texts() == ()
        worker.submit(lambda control: control.home(SIMULATED_HOMING)).result(LONGEST_S)
        until(lambda: worker.state.homing is not None and worker.state.homing.phase is not HomingPhase.SEARCHING)
        assert worker.state.homing.phase is HomingPhase.DONE and all(worker.state.status.homed)
        # where the struts of this machine are counted from is its home, within a count of 0.1 um
        assert worker.state.pose.tip == pytest.approx(MACHINE.home_tip, abs=1e-3)
        before = worker.state.pose.tip[0]
        plan, reported = worker.submit(lambda control: control.plan_jog(CartesianJog((2, 0, 0)), 10.0)).result(
            LONGEST_S
        )
        assert not reported
        worker.submit(lambda control: control.execute(plan)).result(LONGEST_S)
        # struts stand within a count of 0.1 um, which moves the tip by no more than some of them
        until(lambda: worker.state.pose.tip[0] - before == pytest.approx(2.0, abs=1e-3))
    finally:
        connection.close()


def test_it_goes_home_where_struts_are_counted_from_the_end_of_their_stroke():
    target, _ = connection_target(None, "nategh_agheli_nominal")
    assert set(target.settings.zero_length) == {target.machine.strut_stroke[0]}
    connection = connect(target, 100.0, 4.0)
    try:
        worker = connection.worker
        worker.submit(lambda control: control.home(SIMULATED_HOMING)).result(LONGEST_S)
        until(lambda: worker.state.homing is not None and worker.state.homing.phase is not HomingPhase.SEARCHING)
        assert worker.state.pose.tip == pytest.approx(target.machine.home_tip, abs=1e-2)
        plan, reported = worker.submit(lambda control: control.plan_jog(CartesianJog((1, 0, 0)), 5.0)).result(LONGEST_S)
        assert plan is not None and not reported
    finally:
        connection.close()


def test_a_simulated_machine_ends():
    training = SimulatedMachine(MACHINE, SETTINGS, TOOL)
    number = training.port.number
    training.close()
    with pytest.raises(OSError):
        socket.create_connection(("127.0.0.1", number), timeout=1.0)
