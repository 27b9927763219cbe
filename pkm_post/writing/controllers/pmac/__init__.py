# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Turbo PMAC: motion programs written and read back, and the set-up they rely on."""

from pkm_post.model import Diagnostics, StrutMotion
from pkm_post.system import result_files
from pkm_post.writing.controllers.pmac.memory import memory_faults
from pkm_post.writing.controllers.pmac.program import (
    buffer_opening,
    program_parts,
    program_text,
    read_part,
    read_parts,
    read_program,
    rotary_opening,
    rotary_text,
)
from pkm_post.writing.controllers.pmac.settings import PmacSettings, settings_of, setup_text
from pkm_post.writing.controllers.pvt.codes import event_faults
from pkm_post.writing.controllers.pvt.parts import stated_part

SETUP_SUFFIX = result_files.SETUPS["turbo_pmac"]


def faults(motion: StrutMotion, settings: PmacSettings, file: str) -> Diagnostics:
    """The reasons why a motion cannot be written for this controller; ``file`` is the name of the job."""
    return event_faults(motion, settings.codes, file) + memory_faults(motion, settings, file)
