# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document: the name of a document, the types of its objects, and changes of it as one undo step.

Types are distinguished by properties. Nothing of CAM is imported here: commands check types in every workbench.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from pathlib import Path as FilePath
from typing import Any


def document_name(document: Any) -> str:
    """The file name of a document, or its label if it was never saved."""
    return FilePath(document.FileName).name or document.Label


def is_job(item: Any) -> bool:
    """Whether an object is a CAM job; a link to one has its properties as well."""
    return hasattr(item, "Operations") and hasattr(item, "PostProcessor") and item.isDerivedFrom("Path::Feature")


def members(group: Any) -> list[Any]:
    """The objects in a group of a job, such as its ``Operations``; none if the user deleted the group."""
    return [] if group is None else list(group.Group)


def is_program(item: Any) -> bool:
    """Whether an object is a part program."""
    return hasattr(item, "AxisWords") and hasattr(item, "Found")


def is_simulation(item: Any) -> bool:
    """Whether an object is the simulation of a CAM job."""
    return hasattr(item, "ProblemTimes") and hasattr(item, "OperationTimes")


def is_operation(item: Any) -> bool:
    """Whether an object is an operation of a CAM job; tool controllers also have paths."""
    others = is_job(item) or is_program(item) or hasattr(item, "ToolNumber")
    return item.isDerivedFrom("Path::Feature") and not others


def job_of(item: Any) -> Any:
    """The CAM job that an object is or is part of; None if there is none, or more than one.

    An object is part of a job as operation, tool controller, tool bit, stock or model, also as the original of these,
    and as a machine, reach or simulation of the job.
    """
    if is_job(item):
        return item
    named = getattr(item, "Job", None)
    jobs = [named] if named is not None else [each for each in item.InListRecursive if is_job(each)]
    return jobs[0] if len(jobs) == 1 and is_job(jobs[0]) else None


def only_job(document: Any) -> Any:
    """The CAM job of a document with exactly one; else None."""
    jobs = [] if document is None else [item for item in document.Objects if is_job(item)]
    return jobs[0] if len(jobs) == 1 else None


def job_for(items: Sequence[Any], document: Any) -> Any:
    """The CAM job of a selection.

    Args:
        items: the selected objects, none or several.
        document: the active document; None for none.

    Returns:
        The job of all objects that have one; the document's only one if none does; None if the objects have
        several jobs, or if it is ambiguous.
    """
    jobs = {job.Name: job for job in map(job_of, items) if job is not None}
    if jobs:
        return next(iter(jobs.values())) if len(jobs) == 1 else None
    return only_job(document)


@contextlib.contextmanager
def transaction(document: Any, text: str) -> Iterator[None]:
    """Run as one undo step. Any exception restores the document.

    Args:
        text: name of the step in the menu.
    """
    document.openTransaction(text)
    try:
        yield
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()
