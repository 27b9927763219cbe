# SPDX-License-Identifier: LGPL-2.1-or-later
"""PVT: what motion programs of the PMAC family have in common, as writer, reader, settings, codes and parts.

Each controller of the family states its own words and frame; the lines between them are the same.
"""
