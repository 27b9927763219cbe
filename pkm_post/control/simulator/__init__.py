# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated PMAC with six motors, Turbo or Power, for tests and training.

It is written from the manuals and imports no other package: its verdict on a program must not rest on the code that
wrote the program.
"""

from pkm_post.control.simulator.controller import LEAST_MEMORY, Controller, SimulatorSettings, function_programs
from pkm_post.control.simulator.errors import ERROR_TEXTS, CommandError
from pkm_post.control.simulator.ethernet_port import EthernetPort
from pkm_post.control.simulator.gpascii_shell import GpasciiShell, refused_line
from pkm_post.control.simulator.power_online import PowerPmac
from pkm_post.control.simulator.serial_port import SerialPort
from pkm_post.control.simulator.server import Server
