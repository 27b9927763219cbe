#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What an operator does, as the user interface of a LinuxCNC without a screen: switch on, home, run program.ngc.

LinuxCNC starts it in the folder of the configuration; the rows of the sampler go to sampled.txt there.
"""

import subprocess
import sys
import time
from pathlib import Path

import linuxcnc

WAITS, RUNS = 30.0, 300.0
"""s, for one step of the operator and for the program."""

command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()


def wait(what, holds, seconds=WAITS):
    """Until a condition holds; errors of LinuxCNC end the run."""
    end = time.monotonic() + seconds
    while True:
        status.poll()
        if holds():
            return
        if message := errors.poll():
            sys.exit(f"LinuxCNC says {message[1]} while waiting for {what}")
        if time.monotonic() > end:
            sys.exit(f"waited {seconds:g} s for {what}")
        time.sleep(0.02)


def switch_on():
    command.state(linuxcnc.STATE_ESTOP_RESET)
    wait("emergency stop", lambda: status.task_state == linuxcnc.STATE_ESTOP_RESET)
    command.state(linuxcnc.STATE_ON)
    wait("power", lambda: status.task_state == linuxcnc.STATE_ON)
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete()
    for joint in range(6):
        command.home(joint)
    wait("homing", lambda: all(status.homed[:6]))
    command.teleop_enable(1)
    command.mode(linuxcnc.MODE_AUTO)
    wait("automatic mode", lambda: status.task_mode == linuxcnc.MODE_AUTO)


def run_program():
    with (
        open("sampled.txt", "w", encoding="ascii") as rows,
        subprocess.Popen(["halsampler", "-t"], stdout=rows) as sampler,
    ):
        command.program_open(str(Path("program.ngc").resolve()))
        command.wait_complete()
        command.auto(linuxcnc.AUTO_RUN, 0)
        wait("the start of the program", lambda: status.interp_state != linuxcnc.INTERP_IDLE)
        wait("the end of the program", lambda: status.interp_state == linuxcnc.INTERP_IDLE, RUNS)
        time.sleep(0.5)  # the sampler's rows reach the file
        sampler.terminate()


switch_on()
run_program()
Path("finished").write_text("the program ran to its end\n", encoding="ascii")
