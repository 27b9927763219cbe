# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool compensation: tool tip positions from the surface or contour to be cut."""

from pkm_post.toolpath.compensation.apply import compensate
from pkm_post.toolpath.compensation.contact import tip_from_contact, tip_shift
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.compensation.envelope import StockLeft, stock_left
from pkm_post.toolpath.compensation.known_cutter import known_cutter
from pkm_post.toolpath.compensation.options import OffsetOptions
from pkm_post.toolpath.compensation.side import offset_contours
from pkm_post.toolpath.compensation.tips import compensate_tips

__all__ = [
    "Cutter",
    "OffsetOptions",
    "StockLeft",
    "compensate",
    "compensate_tips",
    "known_cutter",
    "offset_contours",
    "stock_left",
    "tip_from_contact",
    "tip_shift",
]
