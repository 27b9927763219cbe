# SPDX-License-Identifier: LGPL-2.1-or-later
"""Transaction: what is done to a document in one step, for one undo to take back."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any


@contextlib.contextmanager
def transaction(document: Any, text: str) -> Iterator[None]:
    """One step of undo. What raises, however it does, leaves the document as it was.

    Args:
        document: that is changed.
        text: what the step is called in the menu.
    """
    document.openTransaction(text)
    try:
        yield
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()
