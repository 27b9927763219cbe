# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post-processor: what CAM calls when a job is posted with one of the post-processors of PKM Post.

CAM makes one for a job, for half a job while it is being made, and for no job at all to show a tooltip: nothing
happens before ``export``. CAM writes the text that ``export`` gives back; the other files lie beside it already.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any, ClassVar

import FreeCAD as App
from Path.Post.Processor import PostProcessor

from pkm_post.freecad_app.selection import EVERYTHING, Selection

TOOLTIPS: dict[str, str] = {
    "hexapod_pmac": "Certified motion programs for hexapod machine tools with six telescopic struts and a Turbo PMAC"
    " or Power PMAC controller",
    "hexapod_trajectory": "Binary trajectories (.pkmt) for hexapod machine tools: tool tips and tool axes in the"
    " machine frame",
    "hexapod_linuxcnc": "G-code with X Y Z A B C for hexapod machine tools that LinuxCNC moves",
    "hexapod_gcode": "G-code with tool axes as vectors or as angles of a head, before it is made into the motion of a"
    " hexapod",
}
"""What each is for, by name. CAM asks for it while it starts, so nothing else is imported for it."""


class HexapodPost(PostProcessor):
    """Posts a CAM job as ``pkm_post.freecad_app.post_outputs`` says. A subclass has a name and nothing else."""

    name: ClassVar[str]

    def __init__(self, job: Any) -> None:
        job, self._chosen = _unpacked(job)
        super().__init__(job, tooltip=self.tooltip, tooltipargs="", units="G21")

    @property
    def tooltip(self) -> str:
        """What the post-processor is for."""
        return TOOLTIPS[self.name]

    @property
    def tooltipArgs(self) -> str:
        """What its arguments are."""
        from pkm_post.freecad_app.arguments import arguments_help

        return arguments_help(self.name)

    def export(self) -> list[tuple[str, str]]:
        """The text for CAM to write; what is no text is written beside its place. Nothing if the user stopped it.

        Raises:
            Refused: the job cannot be posted; CAM writes nothing then.
        """
        from pkm_post.freecad_app.job_settings import settings_of
        from pkm_post.freecad_app.post_outputs import OUTPUTS
        from pkm_post.freecad_app.progress import Stopped
        from pkm_post.model import Refused
        from pkm_post.out_of_memory import memory_or_refused

        try:
            with memory_or_refused(self._job.Label):
                settings = settings_of(self._job, post_processor=self.name, selection=self._chosen)
                text, diagnostics = OUTPUTS[self.name](self._job, settings, program_path(self._job))
        except Refused as refused:
            _tell(refused)
            raise
        except Stopped as stopped:
            App.Console.PrintWarning(f"{stopped}\n")
            return []
        for diagnostic in diagnostics:
            App.Console.PrintWarning(f"{diagnostic}\n")
        return [("allitems", text)]

    def export2(self) -> list[tuple[str, str]]:
        """The same for a job that has a machine of FreeCAD: our machine is the one of our arguments."""
        return self.export()

    def get_file_extension(self) -> str:
        """How the name of the text ends, which newer versions ask for when the job has a machine of FreeCAD."""
        return program_path(self._job).suffix.lstrip(".")

    def apply_configuration_bundle(self, overrides: Mapping[str, Any] | None = None) -> None:
        """Take the fixtures that were chosen in the dialog of FreeCAD newer than 1.1; the rest of it is for its own.

        Args:
            overrides: what the dialog says, by name.
        """
        fixtures = (overrides or {}).get("selected_fixtures")
        self._chosen = replace(self._chosen, fixtures=fixtures or None)


def _unpacked(job: Any) -> tuple[Any, Selection]:
    """The job, and what of it is meant: newer versions give both in a dictionary, or the job in a list."""
    if isinstance(job, dict):
        return job["job"], Selection(job.get("operations"))
    if isinstance(job, list):
        (job,) = job
    return job, EVERYTHING


def program_path(job: Any) -> FilePath:
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
