# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knots: the whole milliseconds at which the controller gets a point, and the check of its cubics between them."""
