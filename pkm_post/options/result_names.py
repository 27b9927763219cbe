# SPDX-License-Identifier: LGPL-2.1-or-later
"""Result names: no result of a posting overwrites another one or a source.

Input: the items to post, each with the stem of its results. Output: messages on conflicts. Names that differ only in
case count as equal, as on Windows, macOS and memory sticks. No file is opened, and NumPy is not needed.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from pkm_post.system import result_files

_REQUIRED = (
    result_files.PROGRAM,
    result_files.TRAJECTORY,
    result_files.REPORT,
    result_files.PAGE,
    result_files.MANIFEST,
)
"""Endings of the files that every posting writes, whatever its options."""
_POSSIBLE = (*_REQUIRED, *result_files.SETUPS.values())
"""Endings of the files that a posting without side outputs may write, for any controller."""
_IN_PARTS = (result_files.PROGRAM, *(result_files.SIDE_OUTPUTS[name] for name in ("halstreamer", "cartesian")))
_PART = re.compile(r"(.*)-part[1-9][0-9]*(\.[a-z]+)")


@dataclass(frozen=True)
class PostItem:
    """One source of a motion program with its files.

    Attributes:
        name: display name of a file, or of a job in a document.
        stem: of its results.
        also: side outputs, keys of ``result_files.SIDE_OUTPUTS``.
    """

    name: str
    stem: str
    also: Collection[str] = tuple(result_files.SIDE_OUTPUTS)


def job_stem(document: str, label: str, jobs: int) -> str:
    """Stem of the results of a CAM job.

    Args:
        label: of the job; used where the document has several jobs.
        jobs: number of jobs of the document.
    """
    return re.sub(r"[^\w.-]+", "_", f"{document}-{label}" if jobs > 1 else document)


def result_names(item: PostItem) -> list[str]:
    """File names that posting may write, except those of the second and later parts."""
    return [item.stem + ending for ending in (*_POSSIBLE, *(result_files.SIDE_OUTPUTS[name] for name in item.also))]


def missing_results(items: Sequence[PostItem], out: Path) -> list[Path]:
    """Required results that are absent after posting.

    Args:
        out: the folder for the results.
    """
    required = [out / f"{item.stem}{ending}" for item in items for ending in _REQUIRED]
    return [path for path in required if not path.is_file()]


def result_conflicts(items: Sequence[PostItem]) -> list[str]:
    """Messages on results that would be overwritten if all items were posted to one folder; empty if none."""
    made = [(item, name) for item in items for name in result_names(item)]
    return list(dict.fromkeys([*_same_names(made), *_names_of_parts(items, made)]))


def _same_names(made: Sequence[tuple[PostItem, str]]) -> Iterator[str]:
    """Messages on results that two items would write; one per name."""
    owners: dict[str, PostItem] = {}
    reported = set()
    for item, name in made:
        owner = owners.setdefault(name.casefold(), item)
        if owner is not item and (id(owner), id(item)) not in reported:
            reported.add((id(owner), id(item)))
            yield f"{owner.name} and {item.name} would both be posted as {name}"


def _names_of_parts(items: Sequence[PostItem], made: Sequence[tuple[PostItem, str]]) -> Iterator[str]:
    """Messages on results that coincide with a part of another item."""
    wholes = {(item.stem + ending).casefold(): item for item in items for ending in _IN_PARTS}
    for item, name in made:
        part = _PART.fullmatch(name.casefold())
        owner = wholes.get(part.group(1) + part.group(2)) if part else None
        if owner:
            yield f"{item.name} would be posted as {name}, as would a part of {owner.name}"


def overwritten_sources(files: Sequence[Path], items: Sequence[PostItem], out: Path) -> list[str]:
    """Messages on sources that the results of other items would overwrite.

    Args:
        files: the sources.
        items: items posted from them.
        out: the folder for the results.
    """
    sources = {_place(os.path.realpath(file.parent), file.name): file for file in files}
    made = [(item, _place(os.path.realpath(out), name)) for item in items for name in result_names(item)]
    lost = [(sources[target], item) for item, target in made if target in sources]
    return list(dict.fromkeys(f"{source} would be replaced by a result of {item.name}" for source, item in lost))


def _place(folder: str, name: str) -> str:
    return os.path.join(folder, name).casefold()
