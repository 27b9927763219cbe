# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine files: a TOML text becomes a ``model.Machine`` in mm, rad and s, or a list of everything wrong with it."""

from pkm_post.machine_file.named import machine_named
from pkm_post.machine_file.presets import find_machine, presets
from pkm_post.machine_file.reader import read_machine

__all__ = ["find_machine", "machine_named", "presets", "read_machine"]
