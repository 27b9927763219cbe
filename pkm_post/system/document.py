# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document: verify a FreeCAD document on disk and list its CAM jobs, without FreeCAD and without NumPy.

Input: a file. Output: its jobs with their operations and its archive members, or ``DamagedDocument``. FreeCAD accepts
truncated XML and omits missing objects, so the lists are compared here. Entity declarations are refused: FreeCAD never
writes them, and would expand them without limit.
"""

from __future__ import annotations

import zipfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from pkm_post.system.document_archive import DOCUMENT, damaged_content, verified_archive

_JOB = ("Path.Main.Job", "ObjectJob")
"""Module and class of the proxy of a job as stored by FreeCAD."""
_DEEPEST = 100
"""Nesting depth of elements; FreeCAD documents have about ten levels."""
_MEMBERS = ("Path", "Part", "Mesh")
"""Property elements whose value is in another archive member that posting reads."""
_PIECE = 1 << 16


@dataclass(frozen=True)
class Job:
    """A CAM job.

    Attributes:
        operations: names of its operations, in order.
        arguments: of its post-processor.
    """

    name: str
    label: str
    operations: tuple[str, ...]
    arguments: str


@dataclass(frozen=True)
class DocumentContent:
    """Content of a document.

    Attributes:
        jobs: the CAM jobs, in document order.
        members: names of the other archive members that its objects need.
    """

    jobs: tuple[Job, ...]
    members: tuple[str, ...]


def read_document(file: Path) -> DocumentContent:
    """Verify a document and list its content.

    Raises:
        OSError: the file cannot be read.
        DamagedDocument: it is not a document, or not a complete one.
    """
    with file.open("rb") as stream, verified_archive(stream) as archive:
        content = _read_content(_pieces(archive))
        for name in content.members:
            if name not in archive.NameToInfo:
                raise damaged_content(f"{name} is listed and missing in the archive")
        return content


def _pieces(archive: zipfile.ZipFile) -> Iterator[bytes]:
    with archive.open(DOCUMENT) as content:
        while piece := content.read(_PIECE):
            yield piece


def _read_content(pieces: Iterable[bytes]) -> DocumentContent:
    """Content of the XML in chunks, in order."""
    reader = _Reader()
    parser = ElementTree.XMLParser(target=reader)
    try:
        for piece in pieces:
            parser.feed(piece)
        parser.close()
    except (ElementTree.ParseError, ValueError, LookupError) as fault:  # the last two: unknown encodings
        raise damaged_content(f"no XML: {fault}") from fault
    _check_lists(reader)
    members = tuple(name for each in reader.objects for name in each.members)
    return DocumentContent(tuple(_jobs(reader.objects)), members)


@dataclass
class _Object:
    """Extracted data of an object: label, proxy class, links and the members that hold its values."""

    name: str
    label: str
    proxy: tuple[str | None, str | None]
    operations: str
    arguments: str
    group: tuple[str, ...]
    members: list[str]


@dataclass
class _Reader(ElementTree.TreeBuilder):
    """Builds the tree of one object at a time, so a large document is never held in memory as a whole."""

    path: list[str] = field(default_factory=list)
    listed: list[str] = field(default_factory=list)
    counts: dict[str, str] = field(default_factory=dict)
    objects: list[_Object] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()

    def doctype(self, name: str, public: str | None, system: str | None) -> None:
        """Refuse a document type, which is needed only for entities."""
        raise damaged_content("a DOCTYPE, which FreeCAD never writes")

    def start(self, tag: str, attributes: Any) -> ElementTree.Element:
        """Track the element path, and record the declared lengths of lists."""
        self.path.append(tag)
        if self.path[0] != "Document":
            raise damaged_content(f"<{tag}> instead of <Document>")
        if len(self.path) > _DEEPEST:
            raise damaged_content(f"elements are nested more than {_DEEPEST} deep")
        if len(self.path) == 2 and "Count" in attributes:
            self.counts[tag] = attributes["Count"]
        return super().start(tag, attributes)

    def end(self, tag: str) -> ElementTree.Element:
        """Record an object when it is complete, and discard its tree."""
        element = super().end(tag)
        path = tuple(self.path)
        self.path.pop()
        if path == ("Document", "Objects", "Object"):
            self.listed.append(element.get("name", ""))
        elif path == ("Document", "ObjectData", "Object"):
            self.objects.append(_object(element))
            element.clear()
        return element


def _object(element: ElementTree.Element) -> _Object:
    def value(path: str) -> str:
        found = element.find(f"Properties/Property{path}")
        return "" if found is None else found.get("value", "")

    proxies = element.findall("Properties/Property[@name='Proxy']/Python")
    group = element.findall("Properties/Property[@name='Group']/LinkList/Link")
    name = element.get("name", "")
    values = [each for tag in _MEMBERS for each in element.findall(f"Properties/Property/{tag}")]
    return _Object(
        name,
        value("[@name='Label']/String") or name,
        next(((proxy.get("module"), proxy.get("class")) for proxy in proxies), (None, None)),
        value("[@name='Operations']/Link"),
        value("[@name='PostProcessorArgs']/String"),
        tuple(link.get("value", "") for link in group),
        [each.get("file", "") for each in values if each.get("file")],
    )


def _check_lists(reader: _Reader) -> None:
    """Compare the list of objects with the objects and with their declared count."""
    stored = [each.name for each in reader.objects]
    for name in sorted(set(reader.listed) - set(stored)):
        raise damaged_content(f"the object {name} is listed and missing")
    for name in sorted(set(stored) - set(reader.listed)):
        raise damaged_content(f"the object {name} is not in the list of objects")
    for tag, names in (("Objects", reader.listed), ("ObjectData", stored)):
        if reader.counts.get(tag) != str(len(names)) or len(set(names)) < len(names):
            count = reader.counts.get(tag, "no number of")
            raise damaged_content(f"{count} objects declared in <{tag}>, {len(set(names))} found")


def _jobs(objects: list[_Object]) -> Iterable[Job]:
    by_name = {each.name: each for each in objects}
    for each in objects:
        if each.proxy == _JOB:
            operations = by_name[each.operations].group if each.operations in by_name else ()
            for name in sorted(set(operations) - set(by_name)):
                raise damaged_content(f"the operation {name} of {each.label} is missing")
            yield Job(each.name, each.label, operations, each.arguments)
