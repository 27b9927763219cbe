# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated Turbo PMAC with six motors, for tests and training.

It is written from the manuals and imports no other room: its verdict on a program must not rest on the code that wrote
the program.
"""

from pkm_post.pmac_simulator.controller import Controller
from pkm_post.pmac_simulator.errors import MEANINGS, CommandError
from pkm_post.pmac_simulator.ethernet import Packets
from pkm_post.pmac_simulator.line import Line
from pkm_post.pmac_simulator.serve import Server
from pkm_post.pmac_simulator.settings import Settings

__all__ = ["MEANINGS", "CommandError", "Controller", "Line", "Packets", "Server", "Settings"]
