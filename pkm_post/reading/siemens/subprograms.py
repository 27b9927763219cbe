# SPDX-License-Identifier: LGPL-2.1-or-later
"""Subprograms in other files: NAME.SPF or NAME.MPF in the folders of subprograms, for a call of NAME or L123.

Input: folders, and the name of a call. Output: the text of the program with that of the file appended, after a line
%_N_NAME_SPF as in an archive, so that all later steps see one file.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from pkm_post.model import Diagnostic, Diagnostics, Place
from pkm_post.reading.gcode.blocks import SubprogramFile
from pkm_post.reading.gcode.scan import with_line_feeds
from pkm_post.reading.gcode.subprograms import content_of, listed, note_of_file

SUFFIXES = (".spf", ".mpf")


class MissingProgram(Exception):  # noqa: N818 - its file is found, and the program restarts
    """A call of a subprogram in another file.

    Attributes:
        name: name of the call.
        row: of the call.
    """

    def __init__(self, name: str, row: int) -> None:
        super().__init__(name)
        self.name, self.row = name, row


@dataclass(frozen=True)
class Source:
    """A program with the files of its subprograms.

    Attributes:
        text: of all files, lines ended by line feeds.
        files: of subprograms.
        notes: about them, for the report.
    """

    text: bytes
    files: tuple[SubprogramFile, ...] = ()
    notes: tuple[str, ...] = ()

    def with_file(self, name: str, paths: list[Path], place: Place) -> tuple[Source, Diagnostics]:
        """Add the file of a subprogram; the faults of finding and reading it."""
        if len(paths) > 1:
            found = f"{name}: {' and '.join(path.name for path in paths)} in {paths[0].parent}"
            return self, (Diagnostic("G318", place, found),)
        content = content_of(paths[0])
        if isinstance(content, Diagnostic):
            return self, (content,)
        lines = self.text.count(b"\n")
        file = SubprogramFile(name, str(paths[0]), lines, lines + 1)
        note = note_of_file(name, paths[0], content)
        begins = with_line_feeds(content)
        header = b";" if begins.lstrip().startswith(b"%") else f"%_N_{name}_SPF".encode("latin-1")
        return Source(b"".join([self.text, header, b"\n", begins]), (*self.files, file), (*self.notes, note)), ()


def files_by_name(folders: Iterable[Path]) -> dict[str, list[Path]]:
    """The files of subprograms by name in capitals, for each those in the first folder with any."""
    found: dict[str, list[Path]] = {}
    for folder in folders:
        here: dict[str, list[Path]] = {}
        for path in listed(folder):
            if path.suffix.lower() in SUFFIXES and path.is_file():
                here.setdefault(path.stem.upper(), []).append(path)
        found = here | found
    return found
