# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables: what is written beside the program on request, made from the motion that was certified.

A table is no program: nothing here plays it. It is read back and compared with the motion it was made from.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from pkm_post.controllers import halstreamer, motion_csv
from pkm_post.model import Diagnostic, StrutMotion


class Table(Protocol):
    """What the module of a table offers.

    Attributes:
        SUFFIX: how the name of its file goes on behind that of the job.
    """

    SUFFIX: str

    def texts(self, motion: StrutMotion, heading: Sequence[str]) -> tuple[str, ...]:
        """The table, in one text or in several; the heading is for people."""

    def measured(self, texts: Sequence[tuple[str, str]], motion: StrutMotion) -> tuple[str, tuple[Diagnostic, ...]]:
        """File names and texts, read back and compared with the motion: what was found, in words, and the faults."""


TABLES: dict[str, Table] = {"csv": motion_csv, "halstreamer": halstreamer}
"""By the word that people type."""
