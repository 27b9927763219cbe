# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frame: what all steps of a run share, and the result of the run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pkm_post.model import Machine, Tolerances
from pkm_post.options import Options
from pkm_post.posting.run import Findings
from pkm_post.writing import Controller


@dataclass(frozen=True)
class Posted:
    """The result of posting.

    Attributes:
        program: the motion program, or the first of its parts.
        files: all files written, including the program.
        report: the content of the report file.
        diagnostics: warnings.
        parts: the files of the motion program, in order of execution.
    """

    program: Path
    files: tuple[Path, ...]
    report: dict[str, Any]
    diagnostics: Findings
    parts: tuple[Path, ...]


@dataclass(frozen=True)
class Frame:
    """What all steps share.

    Attributes:
        path: path of the motion program; the other files take its folder and its stem.
        machine: the machine of the program.
        controller: the controller of the machine.
        settings: settings of the controller, of its own class.
        options: the user's choices.
    """

    path: Path
    machine: Machine
    controller: Controller
    settings: Any
    options: Options

    @property
    def tolerances(self) -> Tolerances:
        """The requested tolerances."""
        return self.options.tolerances

    def beside(self, ending: str) -> Path:
        """The path of an accompanying file."""
        return self.path.with_name(self.path.stem + ending)
