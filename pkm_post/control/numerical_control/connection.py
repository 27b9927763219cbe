# SPDX-License-Identifier: LGPL-2.1-or-later
"""Connection: turn a port and a machine file into a worker that operates the machine, and into what must be closed.

Enters: the name of a port and of a machine, or a machine alone for simulation. Leaves: a connection, or what is wrong
with the names. Connecting blocks until the controller answers, so windows connect in a thread.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pkm_post.control.link.ports import Port, port_named
from pkm_post.control.link.session import Leftover, Session
from pkm_post.control.numerical_control.control import NumericalControl
from pkm_post.control.numerical_control.training import Training
from pkm_post.control.numerical_control.worker import Worker
from pkm_post.machine import machine_named
from pkm_post.model import Diagnostic, Machine
from pkm_post.options import MANUAL_MOVE_PROGRAM
from pkm_post.writing import pmac, power_pmac


@dataclass(frozen=True)
class Target:
    """Where to connect.

    Attributes:
        port: of the controller; None for a simulated one.
        machine: the machine.
        settings: of its controller: a Turbo PMAC or, over ssh, a Power PMAC.
    """

    port: Port | None
    machine: Machine
    settings: Any

    @property
    def watch_only(self) -> bool:
        """Whether this controller can only be monitored and stopped."""
        return self.port is not None and self.port.is_power


@dataclass(frozen=True)
class Connection:
    """A machine that responded.

    Attributes:
        target: where the connection leads.
        worker: executes orders.
    """

    target: Target
    worker: Worker
    _session: Session
    _training: Training | None

    @property
    def simulated(self) -> bool:
        """Whether the machine is simulated."""
        return self._training is not None

    def close(self) -> None:
        """Close worker, link and simulation; the machine is not stopped.

        Raises:
            RuntimeError: the worker does not end, or has crashed.
        """
        try:
            self.worker.close()
        finally:
            self._session.close()
            if self._training is not None:
                self._training.close()


def target_of(port: str | None, machine: str) -> tuple[Target | None, tuple[Diagnostic, ...]]:
    """Resolve the names of a port and a machine.

    Args:
        port: a name for ``ports.port_named``; None for a simulated machine.
        machine: name or path of a machine file.

    Raises:
        ValueError: the port name has no known form.
    """
    found = None if port is None else port_named(port)
    model, told = machine_named(machine)
    if model is None:
        return None, told
    kind: Any = power_pmac if found is not None and found.is_power else pmac
    settings, faults = kind.settings_of(model)
    return (None if settings is None else Target(found, model, settings)), told + tuple(faults)


def connect(target: Target, tool_length: float, simulated_speed: float = 1.0) -> Connection:
    """Connect to the controller and start polling its state.

    Args:
        target: where to connect.
        tool_length: gauge length of the tool in the spindle, mm.
        simulated_speed: simulated seconds per real second.

    Raises:
        PmacError: no controller answers, or it denies access.
        ValueError: the length is not positive.
    """
    training, port = None, target.port
    if port is None:
        training = Training(target.machine, target.settings, tool_length, simulated_speed)
        port = port_named(training.port)
    session = Session(port, leftover=Leftover.STOP)
    number = _own_number(target.settings.program)
    try:
        control = NumericalControl(session, target.machine, target.settings, tool_length, number)
        session.open()
        return Connection(target, Worker(control), session, training)
    except BaseException:
        session.close()
        if training is not None:
            training.close()
        raise


def _own_number(of_jobs: int) -> int:
    """A program number for manual moves that differs from that of the jobs."""
    return MANUAL_MOVE_PROGRAM if of_jobs != MANUAL_MOVE_PROGRAM else MANUAL_MOVE_PROGRAM - 1
