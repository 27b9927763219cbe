# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control: the link to a controller, its simulator, and numerical control."""

from pkm_post.control.link.channel import OpenBufferPolicy
from pkm_post.control.link.download import download
from pkm_post.control.link.errors import (
    CancelledError,
    LinkLostError,
    NotOwnerError,
    NotReadyError,
    PmacError,
    RefusedError,
)
from pkm_post.control.link.ownership import claim, owned
from pkm_post.control.link.ports import Port, port_named
from pkm_post.control.link.program import Job
from pkm_post.control.link.run import check_setup, resume_program, set_feed_override, start_program
from pkm_post.control.link.session import Session
from pkm_post.control.link.ssh_link import PASSWORD, ssh_package
from pkm_post.control.link.status import Array, Bits, Status, is_busy, read_status, settled_status
from pkm_post.control.link.stopping import EMERGENCY_STEPS, NOT_AT_REST, REST_DEADLINE_S, abort, hold
from pkm_post.control.link.stream import stream
from pkm_post.control.link.tool_pose import ToolPoseReadout, activity_text, pose_text, state_text
from pkm_post.control.loading import certified, job_to_load
from pkm_post.control.numerical_control.connection import (
    SIMULATED_HOMING,
    Connection,
    ConnectionTarget,
    connect,
    connection_target,
)
from pkm_post.control.numerical_control.control import ControlState, NumericalControl
from pkm_post.control.numerical_control.execute import continue_after_stop, program_stops, target_deviation
from pkm_post.control.numerical_control.homing import Homing, HomingPhase, check_trigger, missing_homes, start_homing
from pkm_post.control.numerical_control.interlocks import (
    Interlock,
    OperatorCommand,
    PanelState,
    active_interlocks,
    blocking_interlock,
    may_move,
)
from pkm_post.control.numerical_control.manual_moves import CartesianJog, Jog, MdiSettings, StrutJog
from pkm_post.control.numerical_control.plan import Plan
from pkm_post.control.numerical_control.single_block import BlockDisplay, ProgramBlocks, read_blocks
from pkm_post.control.player.orders import Order, PlayOptions, PlayState
from pkm_post.control.player.play import Player, PlayResult
from pkm_post.control.player.playable import first_row, read_playable
from pkm_post.control.simulator.controller import LEAST_MEMORY, Controller, SimulatorSettings
from pkm_post.control.simulator.errors import ERROR_TEXTS
from pkm_post.control.simulator.gpascii_shell import refused_line
from pkm_post.control.simulator.power_online import PowerPmac
from pkm_post.control.simulator.serial_port import SerialPort
from pkm_post.control.simulator.server import Server

__all__ = [
    "REST_DEADLINE_S",
    "SIMULATED_HOMING",
    "LEAST_MEMORY",
    "ERROR_TEXTS",
    "NOT_AT_REST",
    "EMERGENCY_STEPS",
    "Array",
    "Bits",
    "PlayOptions",
    "Order",
    "PlayResult",
    "PlayState",
    "Player",
    "ProgramBlocks",
    "CancelledError",
    "CartesianJog",
    "Connection",
    "Controller",
    "PASSWORD",
    "PowerPmac",
    "PanelState",
    "Homing",
    "Job",
    "Jog",
    "OpenBufferPolicy",
    "SerialPort",
    "LinkLostError",
    "NotOwnerError",
    "NotReadyError",
    "NumericalControl",
    "StrutJog",
    "OperatorCommand",
    "HomingPhase",
    "Plan",
    "PmacError",
    "Port",
    "MdiSettings",
    "ToolPoseReadout",
    "RefusedError",
    "Server",
    "Session",
    "BlockDisplay",
    "SimulatorSettings",
    "ControlState",
    "Status",
    "ConnectionTarget",
    "Interlock",
    "activity_text",
    "first_row",
    "read_blocks",
    "read_playable",
    "certified",
    "check_setup",
    "check_trigger",
    "connect",
    "download",
    "active_interlocks",
    "continue_after_stop",
    "is_busy",
    "job_to_load",
    "may_move",
    "missing_homes",
    "target_deviation",
    "abort",
    "hold",
    "resume_program",
    "set_feed_override",
    "start_program",
    "owned",
    "refused_line",
    "ssh_package",
    "port_named",
    "pose_text",
    "read_status",
    "blocking_interlock",
    "settled_status",
    "start_homing",
    "state_text",
    "program_stops",
    "stream",
    "claim",
    "connection_target",
]
