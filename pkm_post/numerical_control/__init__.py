# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numerical control: the machine looked at, jogged, homed, and its program started, stepped, slowed, held and ended."""
