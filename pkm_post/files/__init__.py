# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files: how results get their final names, and what one process at a time may have."""

from pkm_post.files.moved import MixedError
from pkm_post.files.staged import BusyError, staged

__all__ = ["BusyError", "MixedError", "staged"]
