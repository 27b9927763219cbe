# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spin: rotation of the platform about the tool axis, which does not affect the cut but moves every strut."""
