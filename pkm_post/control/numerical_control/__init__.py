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
from pkm_post.control.numerical_control.manual_moves import CartesianJog, Jog, StrutJog
from pkm_post.control.numerical_control.mdi import MdiSettings
from pkm_post.control.numerical_control.plan import MovePlan
from pkm_post.control.numerical_control.probed_features import (
    Feature,
    measure_bore,
    measure_boss,
    measure_face,
    origin_for,
)
from pkm_post.control.numerical_control.probing import Probe, ProbeInput, ProbeSettings
from pkm_post.control.numerical_control.simulated_probe import Body, SimulatedProbe, body_of
from pkm_post.control.numerical_control.single_block import BlockDisplay, ProgramBlocks, read_blocks
