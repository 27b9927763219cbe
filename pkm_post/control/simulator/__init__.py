# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated Turbo PMAC with six motors, for tests and training.

It is written from the manuals and imports no other room: its verdict on a program must not rest on the code that wrote
the program.
"""

from pkm_post.control.simulator.controller import Controller
from pkm_post.control.simulator.errors import MEANINGS, CommandError
from pkm_post.control.simulator.ethernet import Packets
from pkm_post.control.simulator.line import Line
from pkm_post.control.simulator.serve import Server
from pkm_post.control.simulator.settings import SimulatorSettings

__all__ = ["MEANINGS", "CommandError", "Controller", "Line", "Packets", "Server", "SimulatorSettings"]
