# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report: results and certificate of a posting, as text, JSON, a page for browsers, and pictures."""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.report import summary
from pkm_post.report.page import write_page
from pkm_post.report.results import Results
from pkm_post.report.summary import heading

if TYPE_CHECKING:
    from pkm_post.report.animated_png import animate
    from pkm_post.report.plots import draw_levels, draw_reach, draw_report
else:
    __getattr__ = at_first_use(__name__, {"animated_png": "animate", "plots": "draw_levels draw_reach draw_report"})
