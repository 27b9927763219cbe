# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control: the link to a controller, its simulator, and numerical control."""

from pkm_post.control.link import operate, stopping
from pkm_post.control.link.download import download
from pkm_post.control.link.faults import (
    CancelledError,
    LinkLostError,
    NotOwnerError,
    NotReadyError,
    PmacError,
    RefusedError,
)
from pkm_post.control.link.greeting import Leftover
from pkm_post.control.link.job import Job
from pkm_post.control.link.motion import is_busy, settled_status
from pkm_post.control.link.ownership import owned, take
from pkm_post.control.link.ports import Port, port_named
from pkm_post.control.link.readout import Pose, Readout, activity_text, pose_text, state_text
from pkm_post.control.link.ready import check_setup
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import Array, Bits, Status, read_status
from pkm_post.control.link.stream import stream
from pkm_post.control.loading import job_to_load
from pkm_post.control.numerical_control.connection import Connection, Target, connect, target_of
from pkm_post.control.numerical_control.control import NumericalControl, State
from pkm_post.control.numerical_control.emergency import ADVICE_S, NOT_AT_REST, STEPS
from pkm_post.control.numerical_control.execute import off_target
from pkm_post.control.numerical_control.homing import Homing, Phase, check_trigger, missing_homes, start_homing
from pkm_post.control.numerical_control.mdi import Reading
from pkm_post.control.numerical_control.moves import Cartesian, Jog, OneStrut
from pkm_post.control.numerical_control.permissions import Desk, Order, Why, facts, may_move, refusal
from pkm_post.control.numerical_control.plan import Plan
from pkm_post.control.numerical_control.single_block import Blocks, Shown, blocks_of_program
from pkm_post.control.numerical_control.stops import go_on, stops_of
from pkm_post.control.numerical_control.training import HOMING
from pkm_post.control.simulator.controller import Controller
from pkm_post.control.simulator.errors import MEANINGS
from pkm_post.control.simulator.line import Line
from pkm_post.control.simulator.serve import Server
from pkm_post.control.simulator.settings import LEAST_MEMORY, SimulatorSettings

__all__ = [
    "ADVICE_S",
    "HOMING",
    "LEAST_MEMORY",
    "MEANINGS",
    "NOT_AT_REST",
    "STEPS",
    "Array",
    "Bits",
    "Blocks",
    "CancelledError",
    "Cartesian",
    "Connection",
    "Controller",
    "Desk",
    "Homing",
    "Job",
    "Jog",
    "Leftover",
    "Line",
    "LinkLostError",
    "NotOwnerError",
    "NotReadyError",
    "NumericalControl",
    "OneStrut",
    "Order",
    "Phase",
    "Plan",
    "PmacError",
    "PmacSettings",
    "Port",
    "Pose",
    "Reading",
    "Readout",
    "RefusedError",
    "Server",
    "Session",
    "Shown",
    "SimulatorSettings",
    "State",
    "Status",
    "Target",
    "Why",
    "activity_text",
    "blocks_of_program",
    "check_setup",
    "check_trigger",
    "connect",
    "download",
    "facts",
    "go_on",
    "is_busy",
    "job_to_load",
    "may_move",
    "missing_homes",
    "off_target",
    "operate",
    "owned",
    "port_named",
    "pose_text",
    "read_status",
    "refusal",
    "settled_status",
    "start_homing",
    "state_text",
    "stopping",
    "stops_of",
    "stream",
    "take",
    "target_of",
]
