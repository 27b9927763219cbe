# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Turbo PMAC: motion programs written and read back, and the set-up they rely on."""

from pkm_post.controllers.pmac.codes import event_faults
from pkm_post.controllers.pmac.memory import memory_faults, program_words
from pkm_post.controllers.pmac.program import program_text
from pkm_post.controllers.pmac.reader import read_program
from pkm_post.controllers.pmac.settings import Settings, settings_of
from pkm_post.controllers.pmac.setup import setup_text

__all__ = [
    "Settings",
    "event_faults",
    "memory_faults",
    "program_text",
    "program_words",
    "read_program",
    "settings_of",
    "setup_text",
]
