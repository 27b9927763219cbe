# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document: the name of a document, the types of its objects, and changes of it as one undo step.

Types are distinguished by properties. Nothing of CAM is imported here: commands check types in every workbench.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path as FilePath
from typing import Any


def document_name(document: Any) -> str:
    """The file name of a document, or its label if it was never saved."""
    return FilePath(document.FileName).name or document.Label


def is_job(item: Any) -> bool:
    """Whether an object is a CAM job."""
    return hasattr(item, "Operations") and hasattr(item, "PostProcessor")


def is_program(item: Any) -> bool:
    """Whether an object is a part program."""
    return hasattr(item, "AxisWords") and hasattr(item, "Found")


def is_simulation(item: Any) -> bool:
    """Whether an object is the simulation of a CAM job."""
    return hasattr(item, "ProblemTimes") and hasattr(item, "OperationTimes")


def is_operation(item: Any) -> bool:
    """Whether an object is an operation of a CAM job; tool controllers have paths as well."""
    others = is_job(item) or is_program(item) or hasattr(item, "ToolNumber")
    return item.isDerivedFrom("Path::Feature") and not others


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
