# SPDX-License-Identifier: LGPL-2.1-or-later
"""The link to a PMAC: protocols for serial line, Ethernet and ssh, download, streaming, stops, status, readout."""

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
from pkm_post.control.link.program import PmacJob, PmacProgram
from pkm_post.control.link.run import resume_program, set_feed_override, start_program, watch_program, watch_resumed
from pkm_post.control.link.session import Session
from pkm_post.control.link.setup_check import check_setup
from pkm_post.control.link.ssh_link import PASSWORD, ssh_package
from pkm_post.control.link.status import Status, is_busy, read_status, settled_status
from pkm_post.control.link.stopping import EMERGENCY_STEPS, NOT_AT_REST, REST_DEADLINE_S, abort, hold
from pkm_post.control.link.stream import stream
from pkm_post.control.link.tool_pose import ToolPoseReadout, activity_text, pose_text, state_text
