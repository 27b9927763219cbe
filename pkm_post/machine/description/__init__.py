# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine files: read a TOML text into a ``model.Machine`` in mm, rad and s, or a list of all its faults."""
