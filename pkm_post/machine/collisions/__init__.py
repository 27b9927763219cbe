# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collisions of the machine and its tools with workpiece, stock and fixtures along a trajectory."""
