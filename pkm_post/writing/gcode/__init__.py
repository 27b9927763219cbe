# SPDX-License-Identifier: LGPL-2.1-or-later
"""G-code: ``Program`` to text, in one of its forms."""

from pkm_post.writing.gcode.writer import Form, write

__all__ = ["Form", "write"]
