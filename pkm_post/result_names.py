# SPDX-License-Identifier: LGPL-2.1-or-later
"""Result names: what posting may write, so that no result takes the place of another one, or of a source.

What is posted enters, each with the stem of its results; what would be lost leaves, in words. Capital and small letters
count as the same, since they are to Windows, macOS and memory sticks. No file is opened, and NumPy is not needed.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

_PROGRAM = ".pmc"
_ALWAYS = (_PROGRAM, "-setup.pmc", "-setup.cfg", ".pkmt", "-report.json", "-report.png", "-manifest.json")
"""How the names of results go on behind the stem, whatever the controller is."""
_PROMISED = (_PROGRAM, ".pkmt", "-report.json", "-manifest.json")
"""Those of them that no choice leaves out."""
_ALSO = {"csv": ".csv", "halstreamer": "-halstreamer.txt", "linuxcnc": "-linuxcnc.ngc"}
"""The same of what is written beside the program, by its name in ``options.ALSO``."""
_IN_PARTS = (_PROGRAM, _ALSO["halstreamer"])
_PART = re.compile(r"(.*)-part[1-9][0-9]*(\.[a-z]+)")


@dataclass(frozen=True)
class Item:
    """What becomes one motion program with its files.

    Attributes:
        name: a file, or a job of a document, as people are told of it.
        stem: of its results.
        also: what may be written beside the program, names of ``options.ALSO``.
    """

    name: str
    stem: str
    also: Collection[str] = tuple(_ALSO)


def job_stem(document: str, label: str, jobs: int) -> str:
    """The stem of the results of a CAM job.

    Args:
        document: stem of its document.
        label: of the job; it counts where the document has several.
        jobs: how many jobs the document has.
    """
    return re.sub(r"[^\w.-]+", "_", f"{document}-{label}" if jobs > 1 else document)


def result_names(item: Item) -> list[str]:
    """The names of what posting may write, but for the second part and those that follow it."""
    return [item.stem + ending for ending in (*_ALWAYS, *(_ALSO[name] for name in item.also))]


def missing_results(items: Sequence[Item], out: Path) -> list[Path]:
    """Which results are not there, though all was posted.

    Args:
        items: what was posted.
        out: the folder for the results.
    """
    promised = [out / f"{item.stem}{ending}" for item in items for ending in _PROMISED]
    return [path for path in promised if not path.is_file()]


def lost_results(items: Sequence[Item]) -> list[str]:
    """Which results would be lost if all were posted to one folder, in words; nothing where all is well."""
    made = [(item, name) for item in items for name in result_names(item)]
    return list(dict.fromkeys([*_of_two(made), *_of_parts(items, made)]))


def _of_two(made: Sequence[tuple[Item, str]]) -> Iterator[str]:
    """Results that two would write; one name tells it of two."""
    owners: dict[str, Item] = {}
    told = set()
    for item, name in made:
        owner = owners.setdefault(name.casefold(), item)
        if owner is not item and (id(owner), id(item)) not in told:
            told.add((id(owner), id(item)))
            yield f"{owner.name} and {item.name} would both be posted as {name}"


def _of_parts(items: Sequence[Item], made: Sequence[tuple[Item, str]]) -> Iterator[str]:
    """Results with the name that a part of another one would have."""
    wholes = {(item.stem + ending).casefold(): item for item in items for ending in _IN_PARTS}
    for item, name in made:
        part = _PART.fullmatch(name.casefold())
        owner = wholes.get(part.group(1) + part.group(2)) if part else None
        if owner:
            yield f"{item.name} would be posted as {name}, as would a part of {owner.name}"


def lost_sources(files: Sequence[Path], items: Sequence[Item], out: Path) -> list[str]:
    """Which sources the results of others would replace, in words.

    Args:
        files: the sources.
        items: what is posted of them.
        out: the folder for the results.
    """
    sources = {_place(os.path.realpath(file.parent), file.name): file for file in files}
    made = [(item, _place(os.path.realpath(out), name)) for item in items for name in result_names(item)]
    lost = [(sources[target], item) for item, target in made if target in sources]
    return list(dict.fromkeys(f"{source} would be replaced by a result of {item.name}" for source, item in lost))


def _place(folder: str, name: str) -> str:
    return os.path.join(folder, name).casefold()
