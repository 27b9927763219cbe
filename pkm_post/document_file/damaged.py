# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damaged: a file is not the document that FreeCAD once wrote."""

from __future__ import annotations


class Damaged(Exception):  # noqa: N818 - it is no error of the program
    """The file cannot be what FreeCAD wrote.

    Attributes:
        code: of the diagnostic that says so.
        found: what was found, and where in the file.
    """

    def __init__(self, code: str, found: str) -> None:
        super().__init__(found)
        self.code, self.found = code, found


def is_no_document(found: str) -> Damaged:
    """The file is something else."""
    return Damaged("J101", found)


def archive_is_damaged(found: str) -> Damaged:
    """The archive was changed by something that is not FreeCAD, or ends too early."""
    return Damaged("J129", found)


def content_is_damaged(found: str) -> Damaged:
    """The archive is whole, but what it holds contradicts itself."""
    return Damaged("J130", found)
