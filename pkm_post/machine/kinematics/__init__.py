# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kinematics of the 6-TPS hexapod: inverse, forward, Jacobian, stiffness, rates, screws, cubics of strut lengths."""
