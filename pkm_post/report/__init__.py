# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report: results and certificate of a posting, as text, JSON and pictures."""

from pkm_post.report import plots, summary
from pkm_post.report.animated_png import animate
from pkm_post.report.plots import draw_reach
from pkm_post.report.summary import heading

__all__ = [
    "animate",
    "draw_reach",
    "heading",
    "plots",
    "summary",
]
