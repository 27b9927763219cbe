# SPDX-License-Identifier: LGPL-2.1-or-later
"""Result names: what posting files may write, so that no result takes the place of another one, or of a source.

Paths of sources and the folder for the results enter; what would be lost leaves, in words. No file is read, and NumPy
is not needed. A document with several jobs has names that only FreeCAD knows; here it counts as one with a single job.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

_PROGRAM = ".pmc"
_ALWAYS = (_PROGRAM, "-setup.pmc", "-setup.cfg", ".pkmt", "-report.json", "-report.png")
"""How the names of results go on behind the stem, whatever the controller is."""
_ALSO = {"csv": ".csv", "halstreamer": "-halstreamer.txt", "linuxcnc": "-linuxcnc.ngc"}
"""The same of what is written beside the program, by its name in ``options.ALSO``."""
_IN_PARTS = (_PROGRAM, _ALSO["halstreamer"])
_PART = re.compile(r"(.*)-part[1-9][0-9]*(\.[a-z]+)")
_DOCUMENT = ".fcstd"


def result_names(file: Path, also: Collection[str]) -> list[str]:
    """The names of what posting a file may write, but for the second part and those that follow it.

    Args:
        file: the source.
        also: what is written beside the program, names of ``options.ALSO``.
    """
    return [_stem(file) + ending for ending in (*_ALWAYS, *(_ALSO[name] for name in also))]


def lost_results(files: Sequence[Path], out: Path, also: Collection[str]) -> list[str]:
    """What would be lost if files were posted to one folder, in words; nothing where all is well.

    Args:
        files: the sources.
        out: the folder for the results.
        also: what is written beside the programs, names of ``options.ALSO``.
    """
    made = [(file, name) for file in files for name in result_names(file, also)]
    return list(dict.fromkeys([*_of_two(made), *_of_parts(files, made), *_sources(files, os.path.realpath(out), made)]))


def _of_two(made: Sequence[tuple[Path, str]]) -> Iterator[str]:
    """Results that two files would write; one name tells it of two files."""
    owners: dict[str, Path] = {}
    told = set()
    for file, name in made:
        owner = owners.setdefault(os.path.normcase(name), file)
        if owner is not file and (owner, file) not in told:
            told.add((owner, file))
            yield f"{owner} and {file} would both be posted as {name}"


def _of_parts(files: Sequence[Path], made: Sequence[tuple[Path, str]]) -> Iterator[str]:
    """Results with the name that a part of another one would have."""
    wholes = {os.path.normcase(_stem(file) + ending): file for file in files for ending in _IN_PARTS}
    for file, name in made:
        part = _PART.fullmatch(os.path.normcase(name))
        owner = wholes.get(part.group(1) + part.group(2)) if part else None
        if owner:
            yield f"{file} would be posted as {name}, as would a part of {owner}"


def _sources(files: Sequence[Path], folder: str, made: Sequence[tuple[Path, str]]) -> Iterator[str]:
    """Sources whose place a result would take."""
    sources = {os.path.normcase(os.path.join(os.path.realpath(file.parent), file.name)): file for file in files}
    for file, name in made:
        source = sources.get(os.path.normcase(os.path.join(folder, name)))
        if source:
            yield f"{source} would be replaced by a result of {file}"


def _stem(file: Path) -> str:
    """The stem of the results of a file."""
    return re.sub(r"[^\w.-]+", "_", file.stem) if file.suffix.lower() == _DOCUMENT else file.stem
