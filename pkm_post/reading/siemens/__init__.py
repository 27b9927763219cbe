# SPDX-License-Identifier: LGPL-2.1-or-later
"""Siemens: part programs in the language of Sinumerik controls to ``Program``.

Text to lines and statements: ``scan``, ``tokens``, ``statements``, ``expressions``, ``structure``. Execution, with
variables, jumps, loops and calls: ``interpreter``, ``variables``, ``blocks``. Meaning: ``machine`` and all other files.
"""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.reading.siemens.guess import siemens_evidence

if TYPE_CHECKING:
    from pkm_post.reading.siemens.reader import read
else:
    __getattr__ = at_first_use(__name__, {"reader": "read"})
