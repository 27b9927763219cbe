# SPDX-License-Identifier: LGPL-2.1-or-later
"""A posted program goes to the simulated machine over a link and runs there: where its struts bring tip and axis.

    PYTHONPATH=. python3 tests/examples/column_over_links.py out/tapered_column.pmc

does it with the whole column, which ``make demo`` posts, over TCP and over a pseudo terminal: some minutes. The tests
do it with the upper part of the column, which is built, posted and certified in the same way.
"""

import functools
import math
import os
import sys
import threading
import time
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from best_segment import deviation_from_any

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.control.link import run as operate
from pkm_post.control.link.download import download
from pkm_post.control.link.ports import port_named
from pkm_post.control.link.program import read_job
from pkm_post.control.link.session import Session
from pkm_post.control.link.setup_check import check_setup
from pkm_post.control.link.ssh_link import PASSWORD, ssh_package
from pkm_post.control.link.status import read_status
from pkm_post.control.simulator import Controller, PowerPmac, Server
from pkm_post.control.simulator.gpascii_shell import refused_line
from pkm_post.control.simulator.moves import PvtMove
from pkm_post.geometry import hermite_lengths
from pkm_post.machine import forward, machine_named
from pkm_post.planning import plan
from pkm_post.writing import pmac, power_pmac, trajectory_file

MACHINE = "example_6tps"
SPEED = 8.0
"""Simulated seconds in a second: about what a computer can compute."""
PATIENCE_S = 30.0
"""The simulated controller answers late when the computer is busy."""
LONGEST_S = 600.0


class Recorded(Controller):
    """Keeps where its program wants the struts, at each tick within a PVT move; time is scaled while a program runs."""

    speed = SPEED

    def initialize(self):
        super().initialize()
        self.times, self.places, self.since = [], [], None

    def advance(self, ms):
        super().advance(self.speed * ms if self.runs_program() else ms)

    def _tick(self, ms):
        super()._tick(ms)
        system = self.systems[0]
        move = system.path.current() if system.running else None
        if isinstance(move, PvtMove):
            self.since = move.start if self.since is None else self.since
            self.times.append(system.path.time - self.since)
            self.places.append(self.motors.commanded.copy())

    @property
    def abrupt_stops(self):
        return self.systems[0].path.abrupt_stops


@dataclass(frozen=True)
class Followed:
    """What came of it; deviations of the worst sample in mm and degrees, and what the certificate says of them.

    Attributes:
        samples: milliseconds of the motion that were looked at.
        part: of the motion that they cover, up to 1.
        off: how far a strut was from the cubics of the program, at worst, mm.
        end: how far the struts are from the last lengths of the program, mm.
        words: what the controller has to say at the end.
    """

    samples: int
    part: float
    off: float
    tip: float
    axis: float
    end: float
    words: tuple[str, ...]


TURBO_DRIVES = "I{0}11=320000 I{0}15=10 I{0}16=6000 I{0}17=20 I{0}19=5 I{0}22=200"
POWER_DRIVES = ("FatalFeLimit=20000", "AbortTa=-0.1", "MaxSpeed=6000", "InvAmax=0.05", "JogTa=-0.2", "JogSpeed=200")


@contextmanager
def served(setup, kind, speed, folder):
    """A controller that was set up and homed, behind a link; it and its port."""
    machine = PowerPmac(form=Recorded) if kind == "ssh" else None
    made = machine.controller if machine else Recorded()
    made.speed = speed
    lines = setup.splitlines()
    for motor in range(1, 7):
        drives = [f"Motor[{motor}].{drive}" for drive in POWER_DRIVES] if machine else [TURBO_DRIVES.format(motor)]
        lines += [*drives, f"#{motor}J/", f"#{motor}HMZ"]
    assert refused_line(machine or made, lines) is None
    made.advance(100)
    server, ended = Server(made), threading.Event()
    thread = threading.Thread(target=server.run, args=(ended.is_set,))
    try:
        port = _port(server, machine, kind, folder)
        thread.start()
        yield made, port
    finally:
        ended.set()
        thread.join(LONGEST_S)
        server.close()


def _port(server, machine, kind, folder):
    if machine is None:
        return port_named(f"tcp:127.0.0.1:{server.add_tcp(0)}" if kind == "tcp" else f"serial:{server.add_pty()}")
    os.environ[PASSWORD] = "of the simulated user"
    door = server.add_ssh(machine, ssh_package(), 0, os.environ[PASSWORD])
    known = folder / "known_hosts"
    known.write_text(f"{door.known_host}\n")
    return replace(port_named(f"ssh:{door.user}@127.0.0.1:{door.number}"), known_hosts=known)


def follow(program, kind, speed=SPEED, machine=MACHINE):
    """Download a posted program over a link, run it to its end, and measure where it went.

    Args:
        program: path of the motion program; set-up and trajectory stand beside it.
        kind: ``"tcp"``, ``"serial"`` or, for a Power PMAC, ``"ssh"``.
        speed: simulated seconds in a second.
        machine: name or file of the machine.
    """
    name, (machine, _) = str(machine), machine_named(str(machine))
    settings, _ = (power_pmac if kind == "ssh" else pmac).settings_of(machine)
    job, faults = read_job(program.read_text(), settings, program.name)
    assert not faults
    setup = program.with_name(f"{program.stem}-setup.{'cfg' if kind == 'ssh' else 'pmc'}").read_text()
    with served(setup, kind, speed, program.parent) as (made, port):
        with Session(port, PATIENCE_S) as session:
            check_setup(session, settings, machine.strut_stroke)
            assert download(session, job.program).digest == job.program.digest
            operate.start_program(session, settings, job.program, job.first)
            status, until = read_status(session, settings), time.monotonic() + LONGEST_S
            while status.running:
                assert time.monotonic() < until
                time.sleep(0.05)
                status = read_status(session, settings)
        assert made.abrupt_stops == 0
        times, places = np.array(made.times), np.array(made.places)
    lengths = places / settings.counts_per_mm + np.array(settings.zero_length)
    tip, axis = deviations(name, program, times, lengths)
    return Followed(
        samples=len(times),
        part=len(times) / int(job.motion.time_ms[-1]),
        off=float(np.abs(lengths - played(job.motion, times)).max()),
        tip=float(tip.max()),
        axis=math.degrees(axis.max()),
        end=float(np.abs(status.commanded - job.motion.length[-1]).max()),
        words=status.fault_texts(),
    )


def played(motion, times):
    """Where the cubics of a program want the struts at times in ms, (N, 6) mm."""
    knot = np.clip(np.searchsorted(motion.time_ms, times, side="right") - 1, 0, len(motion) - 2)
    begin, end = motion.time_ms[knot], motion.time_ms[knot + 1]
    cubic = motion.length[knot], motion.speed[knot], motion.length[knot + 1], motion.speed[knot + 1]
    share = (times - begin) / (end - begin)
    return hermite_lengths(*cubic, (end - begin) / 1000, share[:, None])[:, 0]


@functools.cache
def planned(name, program):
    """The machine of a name or file, the ruler of a posted trajectory and its motion, once for all links."""
    machine, _ = machine_named(name)
    trajectory, faults = trajectory_file.read(program.with_suffix(".pkmt"))
    assert not faults, faults
    motion = plan(trajectory, machine, trajectory.tolerances)[0].motion
    return machine, TrajectoryRuler(trajectory, trajectory.tolerances), motion


def deviations(name, program, times, lengths):
    """How far tip (mm) and axis (rad) are from the programmed trajectory at times in ms, (N,) each."""
    machine, ruler, motion = planned(name, program)
    knot = np.clip(np.searchsorted(motion.time_ms, times, side="right") - 1, 0, len(motion) - 2)
    pose = forward(
        machine, lengths, motion.tool_length[knot + 1], motion.tip[knot], motion.axis[knot], motion.spin[knot]
    )
    assert pose.converged.all()
    return deviation_from_any(ruler, pose.tip, pose.axis, motion.segment[knot], motion.segment[knot + 1])


def main(program):
    """Say what came of both links."""
    for kind in ("tcp", "serial"):
        begin = time.monotonic()
        print(f"{kind}: {follow(Path(program), kind)}, {time.monotonic() - begin:.0f} s", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
