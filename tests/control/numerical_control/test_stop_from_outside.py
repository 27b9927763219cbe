# SPDX-License-Identifier: LGPL-2.1-or-later
"""What ends a command that moves the machine holds the machine; people are called when a stop does not show."""

import copy
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from rig import served
from station import SETTINGS, new_station, set_up

from pkm_post.cli import main
from pkm_post.cli.pmac_stop import held_at_the_end
from pkm_post.control.link.errors import CancelledError
from pkm_post.control.link.stopping import EMERGENCY_STEPS, NOT_AT_REST
from pkm_post.control.numerical_control.manual_moves import CartesianJog
from pkm_post.control.simulator import SerialPort, Server
from pkm_post.model import StrutMotion
from pkm_post.writing.controllers.pmac import program_text

ADDON = Path(__file__).parents[3]
LONGEST_S = 240.0
"""On a busy computer."""
SLOW = "6"
"""mm/min: 20 mm take longer than anything that is waited for, however busy the computer is."""
ADDON_PATH = os.pathsep.join([str(ADDON), *(path for path in sys.path if path)])


def until(holds):
    """Wait for what another thread or process does."""
    end = time.monotonic() + LONGEST_S
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.01)


def slow_job(folder):
    """All struts 10 mm longer and back, in two minutes."""
    time_ms = np.arange(0, 120_001, 400)
    turn = 2 * np.pi * time_ms / 120_000
    length = SETTINGS.zero_length + 5 * (1 - np.cos(turn))[:, None]
    speed = (np.pi / 12 * np.sin(turn))[:, None] * np.ones(6)
    speed[[0, -1]] = 0.0
    file = folder / "slow.pmc"
    file.write_text(program_text(StrutMotion(time_ms, length, speed, ()), SETTINGS, ["slow"]))
    return file


@pytest.fixture
def made():
    return copy.deepcopy(set_up())


def started(action, port, *arguments):
    command = ["python3", "-m", "pkm_post", "pmac", action, "--port", port, "--machine", "example_6tps", *arguments]
    environment = os.environ | {"PYTHONPATH": ADDON_PATH}
    return subprocess.Popen(
        command, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def is_moving(made):
    return bool(np.abs(made.motors.speed).max() > 0.0)


JOG, MDI = ("jog", "--x", "20", "--feed", SLOW), ("mdi", f"G91 G1 X20 F{SLOW}")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("action", "number"), [(JOG, signal.SIGTERM), (JOG, signal.SIGINT), (MDI, signal.SIGHUP), (MDI, signal.SIGINT)]
)
def test_a_signal_holds_a_move_by_hand(made, action, number):
    name, *arguments = action
    with served(made) as port:
        process = started(name, port, *arguments)
        until(lambda: is_moving(made) or process.poll() is not None)
        process.send_signal(number)
        _, said = process.communicate(timeout=LONGEST_S)
        assert process.returncode == 1 and "interrupted and held" in said
        assert made.runs_program() and not is_moving(made)


@pytest.mark.slow
def test_ctrl_c_stops_a_homing_and_warns_of_its_plc_program(made):
    made.motors.home_flag[:] = 1e7
    with served(made) as port:
        process = started("home", port, "--trigger", "#1HM #2HM")
        until(lambda: is_moving(made) or process.poll() is not None)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=LONGEST_S)
        assert process.returncode == 1 and "interrupted and at rest: no program runs; A PLC PROGRAM THAT HOMES" in said
        assert not is_moving(made) and not made.motors.moving().any()


def test_ctrl_c_where_nothing_runs_does_not_speak_of_a_hold():
    """As while a play waits for its operator: there is nothing to resume or to abort."""
    station = new_station()
    with (
        pytest.raises(CancelledError, match="interrupted and at rest: no program runs"),
        held_at_the_end(station.control._session, SETTINGS),
    ):
        raise KeyboardInterrupt


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("ends", ["ctrl-c", "fault"])
def test_a_further_signal_does_not_end_the_hold(number, ends):
    """Whoever presses Ctrl-C twice, or closes the terminal after it, has the machine held all the same."""
    station = new_station()
    plan, _ = station.control.plan_jog(CartesianJog((20.0, 0.0, 0.0)), 1.0)
    expected = CancelledError if ends == "ctrl-c" else OSError
    with pytest.raises(expected), held_at_the_end(station.control._session, SETTINGS):
        station.control.execute(plan)
        station.wait(1.0)
        again, carried = iter([number] * 3), station.wire.fault

        def fault(data, out):
            if (now := next(again, None)) is not None:
                signal.raise_signal(now)
            return carried(data, out)

        station.wire.fault = fault
        if ends == "fault":
            raise OSError(28, "no space left for what is printed")
        signal.raise_signal(signal.SIGINT)
    station.wire.fault = carried
    state = station.control.poll().status
    assert state.held and state.standing


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "number"), [("tcp", signal.SIGSTOP), ("serial", signal.SIGKILL)])
def test_a_jog_whose_computer_dies_or_hangs_comes_to_rest_by_itself(made, kind, number):
    """Nothing is sent any more: the controller holds the program within the time that was stated."""
    feed, clock = 5.0, []
    with served(made, kind) as port:
        process = started("jog", port, "--x", "100", "--feed", str(60 * feed))
        until(lambda: np.abs(made.motors.speed).max() > 1.0 or process.poll() is not None)
        stated = next(line for line in iter(process.stdout.readline, "") if "falls silent" in line)
        process.send_signal(number)
        until(lambda: process_is_still(process, number))
        clock.append(made.time)
        start = made.motors.commanded.copy()
        until(lambda: not is_moving(made))
        clock.append(made.time)
        gone = np.abs(made.motors.commanded - start).max() / SETTINGS.counts_per_mm
        process.kill()
        process.communicate(timeout=LONGEST_S)
    within = float(re.search(r"within (\S+) s", stated)[1])
    assert (clock[1] - clock[0]) / 1000 <= within < 2.0
    assert gone <= feed * (within - 0.5)  # a strut is no faster than the tip; half of the speed in the last second
    assert made.systems[0].holding and not is_moving(made)


def process_is_still(process, number):
    """Whether a signal that ends or stops a process has done so."""
    state = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()[0]
    return state == ("Z" if number == signal.SIGKILL else "T")


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_a_stream_at_rest(made, tmp_path, number):
    assert not SerialPort(made).refusal("&1DEFINE ROT 8000")
    with served(made) as port:
        process = started("stream", port, "--uncertified", "--rotary", "8000", str(slow_job(tmp_path)))
        until(lambda: is_moving(made) or process.poll() is not None)
        process.send_signal(number)
        _, said = process.communicate(timeout=LONGEST_S)
        assert process.returncode == 1 and "the machine rests, the rotary buffer is empty" in said
        assert not made.runs_program() and not is_moving(made)


@pytest.mark.slow
def test_a_closed_terminal_holds_a_jog(made):
    """The process leads a session of its own on a pseudo terminal, which is closed under it."""
    primary, secondary = os.openpty()
    with served(made) as port:
        command = ["python3", "-m", "pkm_post", "pmac", "jog", "--port", port, "--machine", "example_6tps", "--x", "20"]
        environment = os.environ | {"PYTHONPATH": ADDON_PATH}
        owner = "import os,sys,fcntl,termios; os.setsid(); fcntl.ioctl(0, termios.TIOCSCTTY, 0)"
        owner += "; os.execvp(sys.argv[1], sys.argv[1:])"
        process = subprocess.Popen(
            ["python3", "-c", owner, *command, "--feed", SLOW],
            env=environment, stdin=secondary, stdout=secondary, stderr=secondary,
        )  # fmt: skip
        os.close(secondary)
        until(lambda: is_moving(made) or process.poll() is not None)
        os.close(primary)
        assert process.wait(LONGEST_S) != 0
        assert made.runs_program() and not is_moving(made)


def test_people_are_called_while_a_stop_is_not_confirmed_and_it_goes_on_trying(made, tmp_path, capsys):
    file = str(slow_job(tmp_path))
    with served(made) as port:
        target = ["--port", port, "--machine", "example_6tps"]
        program = [*target, "--uncertified", file]
        assert main(["pmac", "download", *program]) == 0 and main(["pmac", "run", *program, "--no-watch"]) == 0
        capsys.readouterr()
        hold, said = made.systems[0].hold, []
        made.systems[0].hold = made.systems[0].abort = lambda *_: None
        forget, made.systems[0].forget = made.systems[0].forget, lambda: None
        ended = threading.Thread(target=lambda: said.append(main(["pmac", "hold", *target])))
        ended.start()
        reported = []
        until(lambda: reported.append(capsys.readouterr().err) or NOT_AT_REST[0] in "".join(reported))
        made.systems[0].hold, made.systems[0].forget = hold, forget
        ended.join(LONGEST_S)
        assert said == [0] and not is_moving(made)


def test_whoever_ends_the_trying_is_shown_what_to_do():
    process = started("hold", "tcp:127.0.0.1:1")
    reported = "".join(iter(process.stderr.readline, NOT_AT_REST[-1] + "\n"))
    assert NOT_AT_REST[0] in reported
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=LONGEST_S)
    assert process.returncode == 1 and EMERGENCY_STEPS[1] in said


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_closed_terminal_does_not_end_an_abort(made, tmp_path, number):
    """The signal comes while the program slows down, before its abort is sent."""
    file = str(slow_job(tmp_path))
    with served(made) as port:
        target = ["--port", port, "--machine", "example_6tps", "--uncertified", file]
        assert main(["pmac", "download", *target]) == 0 and main(["pmac", "run", *target, "--no-watch"]) == 0
        made.variables.write("I", 5195, 800.0)  # a hold takes two seconds [TurboPMAC, Isx95]
        process = started("abort", port)
        until(lambda: made.systems[0].holding or process.poll() is not None)
        process.send_signal(number)
        assert process.wait(LONGEST_S) == 0 and "no program runs" in process.communicate()[0]
        assert not made.runs_program() and not is_moving(made)


def test_a_stop_waits_for_a_controller_that_does_not_answer_yet(made, capsys):
    """The port is free when the hold begins; the controller comes later."""
    with socket.create_server(("127.0.0.1", 0)) as taken:
        number = taken.getsockname()[1]
    said = []
    command = ["pmac", "hold", "--port", f"tcp:127.0.0.1:{number}", "--machine", "example_6tps"]
    hold = threading.Thread(target=lambda: said.append(main(command)))
    hold.start()
    reported = []
    until(lambda: reported.append(capsys.readouterr().err) or NOT_AT_REST[0] in "".join(reported))
    server, ended = Server(made), threading.Event()
    server.add_tcp(number)
    serving = threading.Thread(target=server.run, args=(ended.is_set,))
    serving.start()
    hold.join(LONGEST_S)
    ended.set()
    serving.join(LONGEST_S)
    server.close()
    assert said == [0]
