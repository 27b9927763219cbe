# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spin: rotation of the platform about the tool axis, which cuts nothing and moves every strut."""
