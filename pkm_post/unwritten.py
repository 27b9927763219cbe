# SPDX-License-Identifier: LGPL-2.1-or-later
"""Unwritten: why a file could not be written, as a diagnostic.

The path of a result and what the system said enter; the diagnostic leaves, the same at every door.
"""

from __future__ import annotations

from pathlib import Path

from pkm_post.files import BusyError, MixedError
from pkm_post.model import Diagnostic, Place

_CODES = ((BusyError, "F109"), (MixedError, "F110"), (OSError, "F101"))


def unwritten(path: Path, fault: OSError) -> Diagnostic:
    """What is to be told of a result that could not be written.

    Args:
        path: of the result.
        fault: what ``files.staged`` or writing into its folder raised.
    """
    code = next(code for kind, code in _CODES if isinstance(fault, kind))
    return Diagnostic(code, Place(str(path)), str(fault))
