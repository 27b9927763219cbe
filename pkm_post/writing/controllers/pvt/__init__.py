# SPDX-License-Identifier: LGPL-2.1-or-later
"""PVT: the common parts of motion programs of the PMAC family: writer, reader, settings, codes and parts.

Each controller of the family defines its own words and frame; the lines between them are the same.
"""
