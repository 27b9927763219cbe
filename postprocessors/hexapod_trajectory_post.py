# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post-processor "hexapod_trajectory" of the CAM workbench: binary trajectories."""

from pkm_post.freecad_app.post_processor import HexapodPost


class HexapodTrajectory(HexapodPost):
    """What "hexapod_trajectory" writes is in the table of ``pkm_post.freecad_app.post_outputs``."""

    name = "hexapod_trajectory"


Hexapod_Trajectory = HexapodTrajectory  # CAM makes this name out of that of the file
