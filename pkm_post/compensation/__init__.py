# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool compensation: tool tip positions from the surface or contour to be cut."""

from pkm_post.compensation.apply import compensate
from pkm_post.compensation.contact import tip_from_contact, tip_shift
from pkm_post.compensation.cutter import Cutter
from pkm_post.compensation.envelope import StockLeft, stock_left
from pkm_post.compensation.known_cutter import known_cutter
from pkm_post.compensation.options import OffsetOptions
from pkm_post.compensation.side import offset_contours
from pkm_post.compensation.tips import compensate_tips

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
