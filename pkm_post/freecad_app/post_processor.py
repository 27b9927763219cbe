# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post-processor: what CAM calls when a job is posted with "hexapod_pmac".

CAM makes one for a job, for half a job while it is being made, and for no job at all to show a tooltip: nothing
happens before ``export``. CAM writes the text that ``export`` gives back; the other files lie beside it already.
"""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import FreeCAD as App
from Path.Post.Processor import PostProcessor

TOOLTIP = "Certified motion programs for hexapod machine tools with six telescopic struts and a Turbo PMAC controller"


class HexapodPmac(PostProcessor):
    """Posts a CAM job by way of ``pkm_post.pipeline``."""

    def __init__(self, job: Any) -> None:
        super().__init__(job, tooltip=TOOLTIP, tooltipargs="", units="G21")

    @property
    def tooltip(self) -> str:
        """What the post-processor is for."""
        return TOOLTIP

    @property
    def tooltipArgs(self) -> str:
        """What its arguments are."""
        from pkm_post.freecad_app.arguments import arguments_help

        return arguments_help()

    def export(self) -> list[tuple[str, str]]:
        """The text of the motion program; trajectory, set-up file and report are written beside its place.

        Raises:
            Refused: the job cannot be posted; CAM writes nothing then.
        """
        from pkm_post.freecad_app.arguments import job_arguments
        from pkm_post.freecad_app.post_job import post_to
        from pkm_post.model import Refused
        from pkm_post.options import options_from, tool_lengths_from

        try:
            chosen = job_arguments(self._job, self._job.PostProcessorArgs)
            options, lengths = options_from(chosen), tool_lengths_from(chosen)
            posted = post_to(_program_path(self._job), self._job, chosen.machine, options, lengths, print)
        except Refused as refused:
            _tell(refused)
            raise
        for diagnostic in posted.diagnostics:
            App.Console.PrintWarning(f"{diagnostic}\n")
        return [("allitems", posted.program.read_text(encoding="ascii"))]


def _program_path(job: Any) -> FilePath:
    """Where CAM is going to write the text."""
    from Path.Post.Utils import FilenameGenerator

    generator = FilenameGenerator(job=job)
    generator.set_subpartname("")
    return FilePath(next(generator.generate_filenames()))


def _tell(refused: Exception) -> None:
    """Show the reasons in the report view, and in the notification area if there is a window."""
    for line in str(refused).splitlines():
        App.Console.PrintError(f"{line}\n")
    if App.GuiUp:
        App.Console.PrintUserError(f"The job was not posted.\n{refused}\n")
