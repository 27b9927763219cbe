# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables: optional outputs beside the program, made from the certified motion.

A table is not a program and is not played here. It is read back and compared with the motion it was made from.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from pkm_post.model import Diagnostic, StrutMotion
from pkm_post.writing.controllers import halstreamer, motion_csv


class Table(Protocol):
    """The interface of a table module.

    Attributes:
        SUFFIX: suffix of its file, appended to the name of the job.
    """

    SUFFIX: str

    def texts(self, motion: StrutMotion, heading: Sequence[str]) -> tuple[str, ...]:
        """The table, as one text or several; the heading is for the user."""

    def measured(self, texts: Sequence[tuple[str, str]], motion: StrutMotion) -> tuple[str, tuple[Diagnostic, ...]]:
        """Read file names and texts back and compare them with the motion: the result in words, and the faults."""


TABLES: dict[str, Table] = {"csv": motion_csv, "halstreamer": halstreamer}
"""Tables by option value."""
