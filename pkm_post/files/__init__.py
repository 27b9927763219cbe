# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files: how results get their final names."""

from pkm_post.files.staged import staged

__all__ = ["staged"]
