# SPDX-License-Identifier: LGPL-2.1-or-later
"""Transaction: groups changes of a document into one undo step."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any


@contextlib.contextmanager
def transaction(document: Any, text: str) -> Iterator[None]:
    """Run as one undo step. Any exception restores the document.

    Args:
        document: the changed document.
        text: name of the step in the menu.
    """
    document.openTransaction(text)
    try:
        yield
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()
