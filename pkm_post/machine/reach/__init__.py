# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach: whether the machine can follow a path, with the margin to every limit, also between the poses."""
