# SPDX-License-Identifier: LGPL-2.1-or-later
"""Connection: a worker that operates the machine of a port and a machine file, and its shutdown.

Input: the name of a port and of a machine, or only a machine for simulation. Output: a connection, or the faults
of the names. Connecting blocks until the controller answers, so the GUI connects in a thread.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import Any

from pkm_post.control.link.channel import OpenBufferPolicy
from pkm_post.control.link.ports import Port, port_named
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import AnySettings
from pkm_post.control.numerical_control.control import NumericalControl
from pkm_post.control.numerical_control.worker import Worker
from pkm_post.control.simulator import Controller, PowerPmac, Server, SimulatorSettings, function_programs, refused_line
from pkm_post.control.simulator.server import LOOPBACK
from pkm_post.machine import lengths_at, machine_named
from pkm_post.model import Diagnostics, Machine
from pkm_post.options import MANUAL_MOVE_PROGRAM
from pkm_post.toolpath import ToolPose
from pkm_post.writing import PowerPmacSettings, pmac, power_pmac

SIMULATED_HOMING = " ".join(f"#{motor}HM" for motor in range(1, 7))
"""The line that homes a simulated machine; the order of its motors does not matter."""

_TICK_MS = 4.0
"""Coarser than the simulator's default, as it shares the processor with the GUI."""
_FLAG_MM = 5.0
"""Distance from a motor's position at power-up to its flag."""
_DRIVES = "I{0}11={1:.0f} I{0}15={2:.6f} I{0}16={3:.6f} I{0}17={4:.6f} I{0}19={5:.6f} I{0}22={6:.6f} I{0}23={7:.6f}"
_PER_COUNT = (32.0, 0.001, 0.2, 0.002, 0.0005, 0.05, 0.005)
"""Per count/mm: following error of 2 mm in 16ths, then mm/s and mm/s^2 in counts and ms: aborts at 1000 mm/s^2,
programs up to 200 mm/s and 2000 mm/s^2, jogs at 500 mm/s^2 and 50 mm/s, homing at 5 mm/s towards the flags."""
_CLOSE_S = 10.0


class SimulatedMachine:
    """The simulated machine, with the controller that its machine file names."""

    def __init__(self, machine: Machine, settings: AnySettings, tool_length: float, speed: float = 1.0) -> None:
        """Start serving.

        Args:
            tool_length: gauge length of the tool in the spindle, mm.
            speed: simulated seconds per real second.
        """
        made = _controller(settings, machine)
        self._controller, self._is_homed = made.controller if isinstance(made, PowerPmac) else made, False
        self._home_lines = _home_jogs(machine, settings, tool_length)
        self._server, self._closed = Server(self._controller, speed), threading.Event()
        if isinstance(made, PowerPmac):
            self.port = Port("shell", LOOPBACK, self._server.add_shell(made))
        else:
            self.port = Port("tcp", LOOPBACK, self._server.add_tcp(0))
        self._thread = threading.Thread(target=self._run, name="simulated machine", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Shut down; connected clients lose the link.

        Raises:
            RuntimeError: the thread does not end.
        """
        self._closed.set()
        self._thread.join(_CLOSE_S)
        if self._thread.is_alive():
            raise RuntimeError(f"the simulated machine does not end within {_CLOSE_S:g} s")

    def _run(self) -> None:
        try:
            self._server.run(self._turn)
        finally:
            self._server.close()

    def _turn(self) -> bool:
        """Called by the server thread like the PLC programs of a controller; return whether to end."""
        motors = self._controller.motors
        if not motors.homed.all():
            self._is_homed = False
        elif not self._is_homed and not motors.moving().any():
            self._is_homed = True
            self._controller.load(self._home_lines)
        return self._closed.is_set()


def _home_jogs(machine: Machine, settings: AnySettings, tool_length: float) -> list[str]:
    """Lines that move the struts to the machine's home; none if that exceeds their stroke."""
    length = lengths_at(machine, ToolPose.at_home(machine), tool_length)
    shortest, longest = machine.strut_stroke
    if length.min() < shortest or length.max() > longest:
        return []
    counts = (length - settings.zero_length) * settings.counts_per_mm
    return [f"#{motor}J={count:.0f}" for motor, count in enumerate(counts, start=1)]


def _controller(settings: AnySettings, machine: Machine) -> Controller | PowerPmac:
    """A controller set up for the machine with its M codes, with fast enough drives."""
    scale = settings.counts_per_mm
    motors = SimulatorSettings(tick_ms=_TICK_MS, home_flag=_FLAG_MM * scale)
    is_power = isinstance(settings, PowerPmacSettings)
    made = PowerPmac(motors=motors) if is_power else Controller(motors)
    kind: Any = power_pmac if is_power else pmac
    refused = refused_line(made, kind.setup_text(settings, "simulated", machine.strut_stroke).splitlines())
    if refused is not None:
        raise ValueError(f"settings: expected a set-up that the simulator takes, got {refused}")
    controller = made.controller if isinstance(made, PowerPmac) else made
    controller.load(function_programs((*machine.functions, *machine.thread_codes)))
    for motor in range(1, 7):
        controller.load([_DRIVES.format(motor, *(value * scale for value in _PER_COUNT)), f"#{motor}J/"])
    return made


@dataclass(frozen=True)
class ConnectionTarget:
    """Where to connect.

    Attributes:
        port: of the controller; None for a simulated one.
        settings: of its controller: a Turbo PMAC or, over ssh or simulated, a Power PMAC.
    """

    port: Port | None
    machine: Machine
    settings: Any


@dataclass(frozen=True)
class Connection:
    """A connected machine.

    Attributes:
        target: the controller and machine connected to.
    """

    target: ConnectionTarget
    worker: Worker
    _session: Session
    _simulated: SimulatedMachine | None

    @property
    def session(self) -> Session:
        """The session with the controller; only for the worker's thread."""
        return self._session

    @property
    def simulated(self) -> bool:
        """Whether the machine is simulated."""
        return self._simulated is not None

    def close(self) -> None:
        """Close worker, link and simulation; this does not stop the machine.

        Raises:
            RuntimeError: the worker does not end, or has crashed.
        """
        try:
            self.worker.close()
        finally:
            self._session.close()
            if self._simulated is not None:
                self._simulated.close()


def connection_target(port: str | None, machine: str) -> tuple[ConnectionTarget | None, Diagnostics]:
    """Resolve the names of a port and a machine.

    Args:
        port: a name for ``ports.port_named``; None for a simulated machine.
        machine: name or path of a machine file.

    Raises:
        ValueError: the port name has no known form.
    """
    found = None if port is None else port_named(port)
    model, diagnostics = machine_named(machine)
    if model is None:
        return None, diagnostics
    is_power = model.controller.get("kind") == PowerPmacSettings.KIND if found is None else found.is_power
    kind: Any = power_pmac if is_power else pmac
    settings, faults = kind.settings_of(model)
    return (None if settings is None else ConnectionTarget(found, model, settings)), diagnostics + tuple(faults)


def connect(target: ConnectionTarget, tool_length: float, simulated_speed: float = 1.0) -> Connection:
    """Connect to the controller and start polling its state.

    Args:
        target: where to connect.
        tool_length: gauge length of the tool in the spindle, mm.
        simulated_speed: simulated seconds per real second.

    Raises:
        PmacError: no controller answers, or it denies access.
        ValueError: the length is not positive.
    """
    simulated, port = None, target.port
    if port is None:
        simulated = SimulatedMachine(target.machine, target.settings, tool_length, simulated_speed)
        port = simulated.port
    session = Session(port, open_buffer=OpenBufferPolicy.STOP)
    number = _manual_program(target.settings.program)
    try:
        control = NumericalControl(session, target.machine, target.settings, tool_length, number)
        session.open()
        return Connection(target, Worker(control), session, simulated)
    except BaseException:
        session.close()
        if simulated is not None:
            simulated.close()
        raise


def _manual_program(of_jobs: int) -> int:
    """A program number for manual moves that differs from that of the jobs."""
    return MANUAL_MOVE_PROGRAM if of_jobs != MANUAL_MOVE_PROGRAM else MANUAL_MOVE_PROGRAM - 1
