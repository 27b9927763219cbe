# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface finishing: passes of a cutter over parametric surfaces, with tool axes, as a program."""
