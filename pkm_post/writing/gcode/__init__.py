# SPDX-License-Identifier: LGPL-2.1-or-later
"""G-code: ``Program`` to text, in one of its dialects."""

from pkm_post.writing.gcode.tool_axes import GcodeDialect
from pkm_post.writing.gcode.writer import write
