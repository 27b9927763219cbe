# SPDX-License-Identifier: LGPL-2.1-or-later
"""Training: a simulated machine in a thread of its own, to operate before a real one is at hand.

Enters: the settings and the stroke of a machine. Leaves: the name of a port of this computer. Behind it a simulated
Turbo PMAC is set up as posting would set up that of the machine, with its loops closed and without homes, as after the
power came on.
"""

from __future__ import annotations

import threading

from pkm_post.controllers.pmac import Settings, setup_text
from pkm_post.pmac_simulator import Controller, Server
from pkm_post.pmac_simulator import Settings as SimulatorSettings
from pkm_post.pmac_simulator.serve import LOOPBACK

HOMING = " ".join(f"#{motor}HM" for motor in range(1, 7))
"""The line that homes a simulated machine: its motors find their homes in any order."""

_TICK_MS = 4.0
"""Coarser than the simulator's own: it shares its processor with a window."""
_FLAG_MM = 5.0
"""From where a motor stands to its flag."""
_DRIVES = "I{0}11={1:.0f} I{0}15={2:.6g} I{0}16={3:.6g} I{0}17={4:.6g} I{0}19={5:.6g} I{0}22={6:.6g} I{0}23={7:.6g}"
_PER_COUNT = (32.0, 0.001, 0.2, 0.002, 0.0005, 0.02, 0.005)
"""Of one count/mm: following error of 2 mm in 16ths, then what mm/s and mm/s^2 are in counts and ms: aborts at 1000
mm/s^2, up to 200 mm/s and 2000 mm/s^2 in programs, 500 mm/s^2, 20 mm/s by hand and 5 mm/s towards the flags."""
_END_S = 10.0


class Training:
    """The machine.

    Attributes:
        port: where it is, as ``ports.port_named`` takes it.
    """

    def __init__(self, settings: Settings, stroke: tuple[float, float], speed: float = 1.0) -> None:
        """Begin to serve.

        Args:
            settings: of the machine's controller.
            stroke: shortest and longest strut, mm.
            speed: simulated seconds in a second.
        """
        server = Server(_controller(settings, stroke), speed)
        self.port = f"tcp:{LOOPBACK}:{server.add_tcp(0)}"
        self._server, self._over = server, threading.Event()
        self._thread = threading.Thread(target=self._run, name="simulated machine", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End it; whoever is connected loses the link.

        Raises:
            RuntimeError: it does not end.
        """
        self._over.set()
        self._thread.join(_END_S)
        if self._thread.is_alive():
            raise RuntimeError(f"the simulated machine does not end within {_END_S:g} s")

    def _run(self) -> None:
        try:
            self._server.run(self._over.is_set)
        finally:
            self._server.close()


def _controller(settings: Settings, stroke: tuple[float, float]) -> Controller:
    """A controller with the set-up of the machine and drives that are fast enough for it."""
    scale = settings.counts_per_mm
    made = Controller(SimulatorSettings(tick_ms=_TICK_MS, home_flag=_FLAG_MM * scale))
    made.load(setup_text(settings, "training", stroke).splitlines())
    for motor in range(1, 7):
        made.load([_DRIVES.format(motor, *(value * scale for value in _PER_COUNT)), f"#{motor}J/"])
    return made
