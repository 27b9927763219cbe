# SPDX-License-Identifier: LGPL-2.1-or-later
"""Subprograms in other files: found by the number or name of a call, and added to the program that calls them.

Input: a call whose subprogram is missing, and folders. Output: the program with the blocks of the file appended and
lines numbered on, so that all later steps see one program. On Fanuc-style controls M98 P1234 calls O1234, in a file
O1234.nc or similar; on LinuxCNC ``o<name> call`` searches for name.ngc in the folder of the program and in those of
``SUBROUTINE_PATH`` [LinuxCNC, O codes, calling files].
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from pkm_post.model import IN_SUBPROGRAM_FILE, Array, Diagnostic, Diagnostics, Place, Program, errors
from pkm_post.reading.gcode.blocks import Blocks, SubprogramFile, located
from pkm_post.reading.gcode.scan import scan_recovering, with_line_feeds
from pkm_post.reading.language import unread_encoding
from pkm_post.system import read_fault

if TYPE_CHECKING:
    from pkm_post.reading.gcode.calls import MissingProgram

_SUFFIXES = r"\.(?:ngc|nc|cnc|tap|gcode|mpf|spf|sub|eia|iso|txt)"
_BYTES = 256 * 1024 * 1024
"""Size of the largest file to read."""


class Source(NamedTuple):
    """A program with the files of its subprograms.

    Attributes:
        blocks: of all files.
        text: of all files, lines ended by line feeds; the unchanged text of a program without files.
        notes: the files, for the report.
        warnings: of scanning them.
    """

    blocks: Blocks
    text: bytes | str
    notes: tuple[str, ...] = ()
    warnings: Diagnostics = ()

    def with_file(self, missing: MissingProgram, folders: Sequence[Path]) -> tuple[Source, Diagnostics]:
        """Add the file of a missing subprogram.

        Returns:
            This source with the file, or unchanged if there is none; and the faults of finding and scanning it.
        """
        label, paths = _files_of(missing.labels, folders)
        if not paths or any(file.label == label for file in self.blocks.files):
            return self, ()
        if len(paths) > 1:
            found = f"{missing.found}: {' and '.join(path.name for path in paths)} in {paths[0].parent}"
            return self, (Diagnostic("G318", self.blocks.place(missing.row), found),)
        return self._with(label, paths[0])

    def _with(self, label: str, path: Path) -> tuple[Source, Diagnostics]:
        content = content_of(path)
        if isinstance(content, Diagnostic):
            return self, (content,)
        blocks, faults = scan_recovering(content, str(path))
        if errors(faults):
            return self, faults
        text = with_line_feeds(self.text)
        file = SubprogramFile(label, str(path), len(self.blocks), text.count(b"\n") + 1)
        note = note_of_file(label, path, content)
        whole = b"".join([text, b"\n", with_line_feeds(content)])
        warnings = (*self.warnings, *faults)
        return Source(_joined(self.blocks, blocks, file), whole, (*self.notes, note), warnings), ()


def note_of_file(name: str, path: Path, content: bytes) -> str:
    """The note of a report about the file of a subprogram."""
    return f"{name} is the file {path.name}, SHA-256 {hashlib.sha256(content).hexdigest()}"


_NOTE = re.compile(r".+ is the file (.+), SHA-256 ([0-9a-f]{64})")


def files_in_notes(notes: Iterable[str]) -> list[tuple[str, str]]:
    """Names and SHA-256 of the files of subprograms, from all notes of a report."""
    return [(note[1], note[2]) for note in map(_NOTE.fullmatch, notes) if note]


def content_of(path: Path) -> bytes | Diagnostic:
    """The content of the file of a subprogram, or the fault of reading it."""
    try:
        with path.open("rb") as stream:
            content = stream.read(_BYTES + 1)
    except OSError as fault:
        return read_fault(path, fault)
    if len(content) > _BYTES:
        return Diagnostic("F103", Place(str(path)), f"more than {_BYTES} bytes")
    encoding = unread_encoding(content)
    return Diagnostic("F121", Place(str(path)), encoding) if encoding else content


def _files_of(labels: Iterable[str], folders: Sequence[Path]) -> tuple[str, list[Path]]:
    """The first label with files in a folder, and these files."""
    for label in labels:
        number = f"[O:]?0*{int(label)}" if label.isdecimal() else re.escape(label)
        name = re.compile(f"{number}(?:{_SUFFIXES})?", re.IGNORECASE)
        for folder in folders:
            paths = [path for path in listed(folder) if name.fullmatch(path.name) and path.is_file()]
            if paths:
                return label, paths
    return "", []


def listed(folder: Path) -> list[Path]:
    """The entries of a folder; none if it cannot be read: then the call has no subprogram."""
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []


def _joined(blocks: Blocks, more: Blocks, file: SubprogramFile) -> Blocks:
    """Append the blocks of a file, with an empty row between."""
    rows = file.row + 1

    def column(one: Array, between: float, other: Array) -> Array:
        return np.concatenate([one, np.array([between], one.dtype), other])

    letters = sorted({*blocks.words, *more.words})
    return replace(
        blocks,
        line=column(blocks.line, file.before, more.line + file.before),
        words={letter: column(blocks.word(letter), np.nan, more.word(letter)) for letter in letters},
        g=np.concatenate([blocks.g, more.g]),
        g_row=np.concatenate([blocks.g_row, more.g_row + rows]),
        m=np.concatenate([blocks.m, more.m]),
        m_row=np.concatenate([blocks.m_row, more.m_row + rows]),
        deleted=column(blocks.deleted, 0, more.deleted),
        special={**blocks.special, **{row + rows: tree for row, tree in more.special.items()}},
        comments=(*blocks.comments, *((line + file.before, text) for line, text in more.comments)),
        files=(*blocks.files, file),
    )


def with_places(found: Iterable[Diagnostic], files: tuple[SubprogramFile, ...]) -> Diagnostics:
    """Diagnostics with file and line, in place of the line number across all files."""
    return tuple(_with_place(fault, files) for fault in found)


def _with_place(fault: Diagnostic, files: tuple[SubprogramFile, ...]) -> Diagnostic:
    file, line = located(files, fault.place.line)
    if file is None or fault.place.file in {each.path for each in files}:
        return fault
    return replace(fault, place=replace(fault.place, file=file.path, line=line))


def with_operations(program: Program, files: tuple[SubprogramFile, ...]) -> Program:
    """Set the file as the operation of its rows, with line numbers within the file."""
    if not files:
        return program
    before = np.array([0, *(file.before for file in files)])
    operation = np.searchsorted(before, program.line, "right") - 1
    return replace(
        program,
        line=program.line - before[operation],
        operation=operation.astype(np.int32),
        operations=("", *(IN_SUBPROGRAM_FILE + Path(file.path).name for file in files)),
    )
