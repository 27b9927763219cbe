# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Power PMAC: motion programs written and read back, and the set-up they rely on."""

from collections.abc import Sequence

from pkm_post.model import Diagnostic, StrutMotion
from pkm_post.system import result_files
from pkm_post.writing.controllers.power_pmac.program import program_parts, program_text
from pkm_post.writing.controllers.power_pmac.settings import PowerPmacSettings, settings_of
from pkm_post.writing.controllers.power_pmac.setup import setup_text
from pkm_post.writing.controllers.power_pmac.syntax import grammar
from pkm_post.writing.controllers.pvt import reader
from pkm_post.writing.controllers.pvt.codes import event_faults
from pkm_post.writing.controllers.pvt.parts import stated_part

__all__ = [
    "SETUP_SUFFIX",
    "PowerPmacSettings",
    "faults",
    "program_parts",
    "program_text",
    "read_parts",
    "settings_of",
    "setup_text",
    "stated_part",
]

SETUP_SUFFIX = result_files.SETUPS["power_pmac"]


def faults(motion: StrutMotion, settings: PowerPmacSettings, file: str) -> tuple[Diagnostic, ...]:
    """The reasons why a motion cannot be written for this controller.

    Args:
        motion: the motion to be written.
        settings: settings of the controller.
        file: name of the job, for the diagnostics.
    """
    return event_faults(motion, settings.codes, file)


def read_parts(
    texts: Sequence[tuple[str, str]], settings: PowerPmacSettings
) -> tuple[StrutMotion | None, tuple[Diagnostic, ...]]:
    """Read a motion program; as ``pvt.reader.read_parts``."""
    return reader.read_parts(texts, grammar(settings), settings)
