# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post-processor "hexapod_gcode" of the CAM workbench: G-code with tool axes."""

from pkm_post.freecad_app.post_processor import HexapodPost


class HexapodGcode(HexapodPost):
    """What "hexapod_gcode" writes is in the table of ``pkm_post.freecad_app.post_outputs``."""

    name = "hexapod_gcode"


Hexapod_Gcode = HexapodGcode  # CAM makes this name out of that of the file
