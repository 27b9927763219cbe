# SPDX-License-Identifier: LGPL-2.1-or-later
"""Execution for tests: the blocks, or None if there are faults; and the faults."""

from pkm_post.reading.gcode.execute import execute_as_far_as_possible
from pkm_post.reading.gcode.flavours import RS274
from pkm_post.reading.gcode.options import DEFAULT_LIMITS


def execute(blocks, limits=DEFAULT_LIMITS, block_delete=False, flavour=RS274):
    executed, faults = execute_as_far_as_possible(blocks, limits, block_delete, flavour)
    return None if faults else executed, faults
