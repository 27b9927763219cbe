# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool compensation: from what is to be touched to where the tool tip has to be."""

from pkm_post.compensation.contact import tip_from_contact
from pkm_post.compensation.cutter import Cutter

__all__ = ["Cutter", "tip_from_contact"]
