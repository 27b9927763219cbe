# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine files: read a TOML text into a ``model.Machine`` in mm, rad and s, or a list of all its faults."""

from pkm_post.machine.description.named import machine_named
from pkm_post.machine.description.presets import find_machine, presets, templates
from pkm_post.machine.description.reader import machine_of, read_machine
from pkm_post.machine.description.rewrite import CannotRewriteError, with_entries

__all__ = [
    "CannotRewriteError",
    "find_machine",
    "machine_named",
    "machine_of",
    "presets",
    "read_machine",
    "templates",
    "with_entries",
]
