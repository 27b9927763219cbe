# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files: final names of results, and locks between processes."""

from pkm_post.files.moved import MixedError
from pkm_post.files.staged import BusyError, staged

__all__ = ["BusyError", "MixedError", "staged"]
