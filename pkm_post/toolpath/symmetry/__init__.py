# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry: mirrored and rotated copies of a program, their coverage, and passes reversed to keep climb milling."""
