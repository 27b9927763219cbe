# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spindle: how fast it turns, from the speed of the cutting edge over the work."""

from pkm_post.spindle.surface_speed import SurfaceSpeed, with_surface_speed

__all__ = ["SurfaceSpeed", "with_surface_speed"]
