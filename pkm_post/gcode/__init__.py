# SPDX-License-Identifier: LGPL-2.1-or-later
"""G-code: text to ``Program`` in three steps (scan, execute, resolve), and ``Program`` to text."""

from pkm_post.gcode.execute import ExecutionLimits
from pkm_post.gcode.options import ReadOptions
from pkm_post.gcode.read import read
from pkm_post.gcode.writer import Form, write

__all__ = ["ExecutionLimits", "Form", "ReadOptions", "read", "write"]
