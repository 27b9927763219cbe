# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post-processor "hexapod_linuxcnc" of the CAM workbench: G-code for LinuxCNC's hexapod."""

from pkm_post.freecad_app.post_processor import HexapodPost


class HexapodLinuxcnc(HexapodPost):
    """What "hexapod_linuxcnc" writes is in the table of ``pkm_post.freecad_app.post_outputs``."""

    name = "hexapod_linuxcnc"


Hexapod_Linuxcnc = HexapodLinuxcnc  # CAM makes this name out of that of the file
