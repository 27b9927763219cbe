# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numerical control: monitor, jog and home the machine; start, step, override, hold and abort its program."""

from pkm_post.control.numerical_control.connection import (
    SIMULATED_HOMING,
    Connection,
    ConnectionTarget,
    connect,
    connection_target,
)
from pkm_post.control.numerical_control.control import NumericalControl
from pkm_post.control.numerical_control.control_state import ControlState
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
from pkm_post.control.numerical_control.plan import MovePlan
from pkm_post.control.numerical_control.probed_features import (
    ALONG,
    Feature,
    measure_bore,
    measure_boss,
    measure_face,
    origin_for,
)
from pkm_post.control.numerical_control.probing import Probe, ProbeInput, ProbeSettings
from pkm_post.control.numerical_control.simulated_probe import Body, SimulatedProbe, body_of
from pkm_post.control.numerical_control.single_block import BlockDisplay, ProgramBlocks, read_blocks

__all__ = [
    "ALONG",
    "BlockDisplay",
    "Body",
    "CartesianJog",
    "Connection",
    "ConnectionTarget",
    "ControlState",
    "Feature",
    "Homing",
    "HomingPhase",
    "Interlock",
    "Jog",
    "MdiSettings",
    "MovePlan",
    "NumericalControl",
    "OperatorCommand",
    "PanelState",
    "Probe",
    "ProbeInput",
    "ProbeSettings",
    "ProgramBlocks",
    "SIMULATED_HOMING",
    "SimulatedProbe",
    "StrutJog",
    "active_interlocks",
    "blocking_interlock",
    "body_of",
    "check_trigger",
    "connect",
    "connection_target",
    "continue_after_stop",
    "may_move",
    "measure_bore",
    "measure_boss",
    "measure_face",
    "missing_homes",
    "origin_for",
    "program_stops",
    "read_blocks",
    "start_homing",
    "target_deviation",
]
