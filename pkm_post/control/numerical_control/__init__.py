# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numerical control: monitor, jog and home the machine; start, step, override, hold and abort its program."""
