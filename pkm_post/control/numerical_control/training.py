# SPDX-License-Identifier: LGPL-2.1-or-later
"""Training: a simulated machine in its own thread, to practise without a real one.

Enters: a machine, the settings of its controller, its gauge length. Leaves: the name of a port on this computer. A
simulated Turbo PMAC serves it, set up as posting sets up the machine's controller, with closed loops and unhomed, as
after power-up. Once all struts are homed, it moves them to the machine's home pose, as PLC programs of real machines
do: the encoder zeros may lie at the end of the stroke.
"""

from __future__ import annotations

import threading

import numpy as np

from pkm_post.control.simulator import Controller, Server, SimulatorSettings
from pkm_post.control.simulator.serve import LOOPBACK
from pkm_post.machine import strut_lengths
from pkm_post.model import Machine
from pkm_post.writing import PmacSettings, setup_text

HOMING = " ".join(f"#{motor}HM" for motor in range(1, 7))
"""The line that homes a simulated machine; the order of its motors does not matter."""

_TICK_MS = 4.0
"""Coarser than the simulator's default: it shares the processor with a window."""
_FLAG_MM = 5.0
"""Distance from a motor's position at power-up to its flag."""
_DRIVES = "I{0}11={1:.0f} I{0}15={2:.6f} I{0}16={3:.6f} I{0}17={4:.6f} I{0}19={5:.6f} I{0}22={6:.6f} I{0}23={7:.6f}"
_PER_COUNT = (32.0, 0.001, 0.2, 0.002, 0.0005, 0.05, 0.005)
"""Per count/mm: following error of 2 mm in 16ths, then mm/s and mm/s^2 in counts and ms: aborts at 1000 mm/s^2,
programs up to 200 mm/s and 2000 mm/s^2, jogs at 500 mm/s^2 and 50 mm/s, homing at 5 mm/s towards the flags."""
_END_S = 10.0


class Training:
    """The simulated machine.

    Attributes:
        port: its name for ``ports.port_named``.
    """

    def __init__(self, machine: Machine, settings: PmacSettings, tool_length: float, speed: float = 1.0) -> None:
        """Start serving.

        Args:
            machine: the machine.
            settings: of its controller.
            tool_length: gauge length of the tool in the spindle, mm.
            speed: simulated seconds per real second.
        """
        self._controller, self._is_home = _controller(settings, machine.strut_stroke), False
        self._go_home = _way_home(machine, settings, tool_length)
        server = Server(self._controller, speed)
        self.port = f"tcp:{LOOPBACK}:{server.add_tcp(0)}"
        self._server, self._over = server, threading.Event()
        self._thread = threading.Thread(target=self._run, name="simulated machine", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Shut down; connected clients lose the link.

        Raises:
            RuntimeError: the thread does not end.
        """
        self._over.set()
        self._thread.join(_END_S)
        if self._thread.is_alive():
            raise RuntimeError(f"the simulated machine does not end within {_END_S:g} s")

    def _run(self) -> None:
        try:
            self._server.run(self._turn)
        finally:
            self._server.close()

    def _turn(self) -> bool:
        """The server thread calls this as a controller runs its PLC programs; return whether to end."""
        motors = self._controller.motors
        if not motors.homed.all():
            self._is_home = False
        elif not self._is_home and not motors.moving().any():
            self._is_home = True
            self._controller.load(self._go_home)
        return self._over.is_set()


def _way_home(machine: Machine, settings: PmacSettings, tool_length: float) -> list[str]:
    """Lines that move the struts to the machine's home; none if that exceeds their stroke."""
    pose = machine.home_tip[None], machine.home_axis[None], np.array([machine.home_spin]), np.array([tool_length])
    length = strut_lengths(machine, *pose)[0]
    shortest, longest = machine.strut_stroke
    if length.min() < shortest or length.max() > longest:
        return []
    counts = (length - settings.zero_length) * settings.counts_per_mm
    return [f"#{motor}J={count:.0f}" for motor, count in enumerate(counts, start=1)]


def _controller(settings: PmacSettings, stroke: tuple[float, float]) -> Controller:
    """A controller set up for the machine, with drives that are fast enough."""
    scale = settings.counts_per_mm
    made = Controller(SimulatorSettings(tick_ms=_TICK_MS, home_flag=_FLAG_MM * scale))
    made.load(setup_text(settings, "training", stroke).splitlines())
    for motor in range(1, 7):
        made.load([_DRIVES.format(motor, *(value * scale for value in _PER_COUNT)), f"#{motor}J/"])
    return made
