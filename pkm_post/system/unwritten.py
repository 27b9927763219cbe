# SPDX-License-Identifier: LGPL-2.1-or-later
"""Unwritten: diagnostic of a file that could not be written.

Input: the path of a result and the system's error. Output: the diagnostic, the same at every entry point.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pkm_post.system.moved import MixedError
from pkm_post.system.staged import BusyError

if TYPE_CHECKING:
    from pkm_post.model import Diagnostic

_CODES = ((BusyError, "F109"), (MixedError, "F110"), (OSError, "F101"))


def unwritten(path: Path, fault: OSError) -> Diagnostic:
    """Make the diagnostic of a result that could not be written.

    Args:
        path: of the result.
        fault: raised by ``files.staged`` or by writing into its folder.
    """
    from pkm_post.model import Diagnostic, Place

    code = next(code for kind, code in _CODES if isinstance(fault, kind))
    return Diagnostic(code, Place(str(path)), str(fault))
