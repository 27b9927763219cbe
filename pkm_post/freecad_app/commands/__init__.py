# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands: the ``Path.Command`` lists of CAM operations become programs, and programs become such lists."""

from pkm_post.freecad_app.commands.reader import read_commands
from pkm_post.freecad_app.commands.writer import commands_of

__all__ = ["commands_of", "read_commands"]
