# SPDX-License-Identifier: LGPL-2.1-or-later
"""G-code: text to ``Program`` in three steps: scan, execute, resolve."""

from pkm_post.reading.gcode.options import ExecutionLimits, ReadOptions
from pkm_post.reading.gcode.read import read

__all__ = ["ExecutionLimits", "ReadOptions", "read"]
