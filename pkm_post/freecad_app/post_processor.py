# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post-processor: the class that CAM calls to post a job with one of PKM Post's post-processors.

CAM creates one for a job, for an incomplete job during its creation, and for no job at all to show a tooltip: all work
happens in ``export``. CAM writes the text that ``export`` returns; the other files are already in the same folder.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any, ClassVar

import FreeCAD as App
from Path.Post.Processor import PostProcessor

from pkm_post.freecad_app.core_texts import exception_text, fault_text
from pkm_post.freecad_app.job import EVERYTHING, Selection

TOOLTIPS: dict[str, str] = {
    "hexapod_pmac": "Certified motion programs for hexapod machine tools with six telescopic struts and a Turbo PMAC"
    " or Power PMAC controller",
    "hexapod_trajectory": "Binary trajectories (.pkmt) for hexapod machine tools: tool tips and tool axes in the"
    " machine frame",
    "hexapod_linuxcnc": "G-code with X Y Z A B C for hexapod machine tools that LinuxCNC moves",
    "hexapod_gcode": "G-code with tool axes as vectors or as angles of a head, before it is made into the motion of a"
    " hexapod",
}
"""Purpose of each, by name. CAM reads it at startup, so this imports nothing else."""


class HexapodPost(PostProcessor):
    """Posts a CAM job with ``pkm_post.freecad_app.post_outputs``. A subclass adds only a name."""

    name: ClassVar[str]

    def __init__(self, job: Any) -> None:
        job, self._chosen = _unpacked(job)
        self._entered: dict[str, Any] = {}
        super().__init__(job, tooltip=self.tooltip, tooltipargs="", units="G21")

    @property
    def tooltip(self) -> str:
        """Purpose of the post-processor."""
        return TOOLTIPS[self.name]

    @property
    def tooltipArgs(self) -> str:
        """Help on its arguments."""
        from pkm_post.freecad_app.arguments import arguments_help

        return arguments_help(self.name)

    def export(self) -> list[tuple[str, str]]:
        """The text for CAM to write; binary files are written to its folder. Empty if the user cancelled.

        In the GUI a refusal is shown with its reasons as rows, and the list is empty, too: CAM then undoes its
        transaction, while an exception would leave it open, with a traceback in the Report view.

        Raises:
            Refused: without a GUI, or for the dialog of FreeCAD newer than 1.1, the job cannot be posted.
        """
        from pkm_post.freecad_app.job_settings import settings_of
        from pkm_post.freecad_app.post_outputs import output_of
        from pkm_post.freecad_app.post_properties import values_of_properties
        from pkm_post.freecad_app.progress import Stopped
        from pkm_post.freecad_app.sanity import remember_output
        from pkm_post.freecad_app.window import shows_refusal
        from pkm_post.model import Refused
        from pkm_post.system import memory_guard

        try:
            with memory_guard(self._job.Label):
                machine = getattr(self, "_machine", None)
                given = values_of_properties(self._job, self.name, machine, self._entered)
                settings = settings_of(self._job, given, post_processor=self.name, selection=self._chosen)
                output = output_of(self.name, for_dialog=getattr(self, "_dialog_handled", False))
                program = program_path(self._job)
                text, diagnostics = output(self._job, settings, program)
        except Refused as refused:
            if getattr(self, "_dialog_handled", False) or not shows_refusal(self._job, refused.diagnostics):
                _report(refused)
                raise
            App.Console.PrintMessage(f"{exception_text(refused)}\n")
            return []
        except Stopped as stopped:
            App.Console.PrintWarning(f"{stopped}\n")
            return []
        for diagnostic in diagnostics:
            App.Console.PrintWarning(f"{fault_text(diagnostic)}\n")
        if not getattr(self, "_dialog_handled", False):  # the dialog saves it elsewhere or not
            remember_output(self._job, program)
        return [("allitems", text)]

    def export2(self) -> list[tuple[str, str]]:
        """The same for a job with a machine of FreeCAD newer than 1.1.

        Its axes, output and processing options are those of a serial machine and have no meaning here: the machine
        file that our arguments name is used. FreeCAD's own form would write the path without planning or certificate.
        """
        return self.export()

    def get_file_extension(self) -> str:
        """The suffix of the text, queried by newer versions if the job has a FreeCAD machine."""
        return program_path(self._job).suffix.lstrip(".")

    @classmethod
    def get_common_property_schema(cls) -> list[dict[str, Any]]:
        """No common properties of FreeCAD's own posts, such as a preamble: they would have no effect."""
        return []

    @classmethod
    def get_property_schema(cls) -> list[dict[str, Any]]:
        """The arguments, for the dialogs of FreeCAD newer than 1.1."""
        from pkm_post.freecad_app.post_properties import property_schema

        return property_schema(cls.name)

    def apply_configuration_bundle(self, overrides: Mapping[str, Any] | None = None) -> None:
        """Take the fixtures and arguments chosen in the dialog of FreeCAD newer than 1.1.

        Args:
            overrides: settings of the dialog, by name; others are for FreeCAD's posts.
        """
        self._entered = dict(overrides or {})
        self._chosen = replace(self._chosen, fixtures=self._entered.get("selected_fixtures") or None)


def _unpacked(job: Any) -> tuple[Any, Selection]:
    """The job and the selection: newer versions pass both in a dictionary, or the job in a list."""
    if isinstance(job, dict):
        return job["job"], Selection(job.get("operations"))
    if isinstance(job, list):
        (job,) = job
    return job, EVERYTHING


def program_path(job: Any) -> FilePath:
    """The path to which CAM will write the text."""
    from Path.Post.Utils import FilenameGenerator

    generator = FilenameGenerator(job=job)
    generator.set_subpartname("")
    return FilePath(next(generator.generate_filenames()))


def _report(refused: Exception) -> None:
    for line in exception_text(refused).splitlines():
        App.Console.PrintError(f"{line}\n")
