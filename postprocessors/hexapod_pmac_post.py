# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post-processor "hexapod_pmac" of the CAM workbench: motion programs for 6-TPS hexapods with a Turbo PMAC."""

from pkm_post.freecad_app.post_processor import HexapodPost


class HexapodPmac(HexapodPost):
    """What "hexapod_pmac" writes is in the table of ``pkm_post.freecad_app.post_outputs``."""

    name = "hexapod_pmac"


Hexapod_Pmac = HexapodPmac  # CAM makes this name out of that of the file
