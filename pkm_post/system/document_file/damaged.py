# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damaged: a file is not an intact FreeCAD document."""

from __future__ import annotations


class Damaged(Exception):  # noqa: N818 - it is no error of the program
    """The file is not as FreeCAD wrote it.

    Attributes:
        code: diagnostic code.
        found: what was found, and where in the file.
    """

    def __init__(self, code: str, found: str) -> None:
        super().__init__(found)
        self.code, self.found = code, found


def is_no_document(found: str) -> Damaged:
    """The file is not a FreeCAD document."""
    return Damaged("J101", found)


def archive_is_damaged(found: str) -> Damaged:
    """The archive was modified by another program, or is truncated."""
    return Damaged("J129", found)


def content_is_damaged(found: str) -> Damaged:
    """The archive is intact, but its content is inconsistent."""
    return Damaged("J130", found)
