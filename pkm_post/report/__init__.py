# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report: results and certificate of a posting, as text, JSON, a page for browsers, and pictures."""

from pkm_post.report import summary
from pkm_post.report.animated_png import animate
from pkm_post.report.page import write_page
from pkm_post.report.plots import draw_reach, draw_report
from pkm_post.report.results import Results
from pkm_post.report.summary import heading

__all__ = [
    "Results",
    "animate",
    "draw_reach",
    "draw_report",
    "heading",
    "summary",
    "write_page",
]
