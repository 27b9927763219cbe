# SPDX-License-Identifier: LGPL-2.1-or-later
"""CL data: read APT cutter location files, in the dialects of CAM systems, into a ``Program``."""

from pkm_post.reading.cldata.options import (
    CONTOUR_DATA,
    CYCLE_VALUES,
    DIALECTS,
    GOTO_VALUES,
    ReadOptions,
    detect_dialect,
)
from pkm_post.reading.cldata.reader import read
