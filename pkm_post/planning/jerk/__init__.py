# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jerk: the fastest motion along a path with limits of jerk."""
