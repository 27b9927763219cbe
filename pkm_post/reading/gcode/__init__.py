# SPDX-License-Identifier: LGPL-2.1-or-later
"""G-code: text to ``Program`` in three steps.

Scan, text to ``Blocks``: ``scan``, ``lexer``, ``parse``, ``syntax_faults``, ``block_builders``, ``blocks``.
Execute, parameters computed, loops and calls unrolled: ``execute``, ``interpreter``, ``statements``, ``expressions``,
``parameters``, ``o_words``. Resolve, blocks to motions and events: ``resolve`` and all other files.
"""

from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.options import FLAVOUR_NAMES, ExecutionLimits, ReadOptions
from pkm_post.reading.gcode.read import read
from pkm_post.reading.gcode.resolve import resolve
