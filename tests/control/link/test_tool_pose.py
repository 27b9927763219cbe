# SPDX-License-Identifier: LGPL-2.1-or-later
"""The digital readout: forward kinematics of what the controller reports, and bits in words."""

import dataclasses

import numpy as np
import pytest
from machines import direction, example
from rig import SETTINGS, Wire, controller

from pkm_post.control.link import stopping
from pkm_post.control.link.errors import LinkLostError
from pkm_post.control.link.status import Status, _turbo_status, is_busy, read_status
from pkm_post.control.link.status_bits import MotorBits, SystemBits
from pkm_post.control.link.tool_pose import ToolPose, ToolPoseReadout, pose_text, state_text
from pkm_post.machine import strut_lengths

NANOMETRE = 1e-6
GOOD = "880000000401"
"""Activated, amplifier on; no coordinate system; homed; in position [EPICSpmac]."""


@pytest.fixture
def status():
    with Wire(controller()).session() as session:
        return read_status(session, SETTINGS)


def test_the_state_of_a_controller_at_rest(status):
    assert np.allclose(status.length, 500.0) and np.allclose(status.following_error, 0.0)
    assert status.override == 100.0 and status.standing and not status.running and status.fault_texts() == ()


def test_poses_from_lengths(status):
    machine = example()
    readout = ToolPoseReadout(machine, 120.0)
    for tilt in np.linspace(0.0, 25.0, 20):
        tip, axis = np.array([[2 * tilt, -tilt, 300.0 - tilt]]), direction(tilt, 30.0)[None]
        lengths = strut_lengths(machine, tip, axis, np.zeros(1), np.array([120.0]))
        pose = readout.pose(dataclasses.replace(status, length=lengths[0]))
        assert np.allclose(pose.tip, tip[0], atol=NANOMETRE) and np.allclose(pose.axis, axis[0], atol=1e-9)


def test_lengths_without_a_pose_are_reported_and_got_over(status):
    machine = example()
    readout = ToolPoseReadout(machine, 120.0)
    assert readout.pose(dataclasses.replace(status, length=np.full(6, 10.0))) is None
    assert pose_text(None) == "tool: no pose has these strut lengths"
    home = strut_lengths(machine, machine.home_tip[None], np.array([[0.0, 0.0, 1.0]]), np.zeros(1), np.array([120.0]))
    pose = readout.pose(dataclasses.replace(status, length=home[0]))
    assert pose_text(pose).startswith("tip X0.000") or pose_text(pose).startswith("tip X-0.000")


def test_each_bit_has_its_word(status):
    for bits, name, word in (
        (46, "negative_limit", "on its lower limit"), (45, "positive_limit", "on its upper limit"),
        (42, "open_loop", "in open loop"), (34, "homing", "searching its home"),
        (3, "amplifier_fault", "amplifier fault"),
    ):  # fmt: skip
        motor = MotorBits(1 << bits)
        assert motor.has(name) and motor.fault_texts() == (word,)
    motors = (*status.motors[:3], MotorBits(1 << 2), *status.motors[4:])
    text = state_text(dataclasses.replace(status, motors=motors))
    assert "strut 4: following error too large, switched off" in text and "NOT HOMED" in text


def test_bits_are_where_the_manual_has_them():
    # word 1 bit 0: a program runs; word 2 bit 22: run-time error; word 3 bit 1: limit
    assert SystemBits(int("000001000000000000", 16)).has("running")
    assert not SystemBits(int("000001800000000000", 16)).held  # word 2 bit 23: look-ahead [TurboPMAC, ??]
    assert SystemBits(int("000000400000000000", 16)).fault_texts() == ("the program ended with an error",)
    assert SystemBits(int("000000000000000002", 16)).fault_texts() == ("a limit was met",)
    motor = MotorBits(int(GOOD, 16))
    assert motor.has("activated") and motor.has("amplifier_enabled") and motor.has("homed") and not motor.fault_texts()


def test_a_motor_without_power_stands_whatever_its_desired_velocity():
    """Desired Velocity Zero is 0 in open loop [Software Reference, ?]; EPICS's driver asks for the amplifier."""
    made = controller()
    for motor in range(6):
        made.motors.kill(motor)
    with Wire(made).session() as session:
        killed = read_status(session, SETTINGS)
        assert killed.standing and not killed.powered and not is_busy(session)
        assert not stopping.abort(session, SETTINGS).running
    open_loop = MotorBits.read("8C0000008400")  # with its amplifier on, an output may move it
    assert open_loop.has("open_loop") and not open_loop.has("standing")


def test_counts_become_lengths():
    reported = [GOOD, "12345.5", "-20"] * 6 + ["0" * 18, "50"]
    state = _turbo_status(tuple(reported), SETTINGS)
    assert isinstance(state, Status)
    assert state.length[0] == pytest.approx(501.23455) and state.following_error[5] == pytest.approx(-0.002)


@pytest.mark.parametrize(
    "reported", [["1"] * 20, ["0" * 12, "1", "1"] * 6 + ["0" * 18], ["0" * 12, "x", "1"] * 6 + ["0" * 18, "1"]]
)
def test_an_answer_without_sense_is_reported(reported):
    class Session:
        def query(self, query):
            return tuple(reported)

    with pytest.raises(LinkLostError):
        read_status(Session(), SETTINGS)


def test_zero_has_no_sign(status):
    """A readout that flickers between 0.000 and -0.000 looks like a motion."""
    pose = ToolPose(np.array([-0.0004, -1e-9, -0.0005001]), np.array([-1e-9, -0.0, 1.0]), -1e-9)
    assert pose_text(pose).startswith("tip X0.000 Y0.000 Z-0.001 mm, axis I0.00000 J0.00000 K1.00000")
    assert pose_text(pose).endswith("spin 0.000 deg")
    assert "-" not in state_text(dataclasses.replace(status, following_error=np.full(6, -1e-5)))
