# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frame: what is the same for all steps of a run, and what is left when they are done."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pkm_post.controllers import Controller
from pkm_post.model import Machine
from pkm_post.model.certificate import Tolerances
from pkm_post.pipeline.options import Options
from pkm_post.pipeline.run import Findings


@dataclass(frozen=True)
class Posted:
    """What was made.

    Attributes:
        program: the motion program, or the first of its parts.
        files: everything that was written, the program included.
        report: the content of the report file.
        diagnostics: warnings.
        parts: the files of the motion program, in the order in which they run.
    """

    program: Path
    files: tuple[Path, ...]
    report: dict[str, Any]
    diagnostics: Findings
    parts: tuple[Path, ...]


@dataclass(frozen=True)
class Frame:
    """What all steps need to know.

    Attributes:
        path: of the motion program; the other files take its folder and its stem.
        machine: that the program is for.
        controller: of the machine.
        settings: of the controller, of a class of its own.
        options: what the user chose.
    """

    path: Path
    machine: Machine
    controller: Controller
    settings: Any
    options: Options

    @property
    def tolerances(self) -> Tolerances:
        """What was asked for."""
        return self.options.tolerances

    def beside(self, ending: str) -> Path:
        """The path of another file."""
        return self.path.with_name(self.path.stem + ending)
