# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post-processor "hexapod_pmac" of the CAM workbench: motion programs for 6-TPS hexapods with a Turbo PMAC."""

from pkm_post.freecad_app.post_processor import HexapodPmac

Hexapod_Pmac = HexapodPmac  # CAM makes this name out of that of the file
