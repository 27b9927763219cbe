# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post-processor "hexapod_machine": "hexapod_pmac" for the machines that FreeCAD newer than 1.1 keeps.

Its machine editor lists posts of this type only, and its jobs list the others only.
"""

from pkm_post.freecad_app.post_processor import HexapodPost

POST_TYPE = "machine"


class HexapodMachine(HexapodPost):
    """What it writes is that of "hexapod_pmac"."""

    name = "hexapod_pmac"


Hexapod_Machine = HexapodMachine  # CAM makes this name out of that of the file
