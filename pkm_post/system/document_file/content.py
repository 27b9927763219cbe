# SPDX-License-Identifier: LGPL-2.1-or-later
"""Content: extract from the XML of a FreeCAD document its objects, CAM jobs with operations, and other members.

Enters: XML in chunks. Leaves: a table, or ``Damaged``. FreeCAD accepts truncated XML and omits missing objects, so the
lists are compared here. Entity declarations are refused: FreeCAD never writes them, and would expand them without
limit.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any
from xml.etree import ElementTree

from pkm_post.system.document_file.damaged import content_is_damaged

_JOB = ("Path.Main.Job", "ObjectJob")
"""Module and class of the proxy of a job as stored by FreeCAD."""
_DEEPEST = 100
"""Nesting depth of elements; FreeCAD documents have about ten levels."""
_MEMBERS = ("Path", "Part", "Mesh")
"""Property elements whose value is in another archive member that posting reads."""


@dataclass(frozen=True)
class Job:
    """A CAM job.

    Attributes:
        name: of the object.
        label: displayed name.
        operations: names of its operations, in order.
    """

    name: str
    label: str
    operations: tuple[str, ...]


@dataclass(frozen=True)
class DocumentContent:
    """What a document lists.

    Attributes:
        jobs: the CAM jobs, in document order.
        members: names of the other archive members that its objects need.
    """

    jobs: tuple[Job, ...]
    members: tuple[str, ...]


@dataclass
class _Object:
    """Extracted data of an object: label, proxy class, links and the members that hold its values."""

    name: str
    label: str
    proxy: tuple[str | None, str | None]
    operations: str
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
        raise content_is_damaged("a DOCTYPE, which FreeCAD never writes")

    def start(self, tag: str, attributes: Any) -> ElementTree.Element:
        """Track the element path, and record the declared lengths of lists."""
        self.path.append(tag)
        if self.path[0] != "Document":
            raise content_is_damaged(f"<{tag}> instead of <Document>")
        if len(self.path) > _DEEPEST:
            raise content_is_damaged(f"elements are nested more than {_DEEPEST} deep")
        if len(self.path) == 2 and "Count" in attributes:
            self.counts[tag] = attributes["Count"]
        return super().start(tag, attributes)

    def end(self, tag: str) -> ElementTree.Element:
        """Record an object when it is complete, and discard its tree."""
        element = super().end(tag)
        way = tuple(self.path)
        self.path.pop()
        if way == ("Document", "Objects", "Object"):
            self.listed.append(element.get("name", ""))
        elif way == ("Document", "ObjectData", "Object"):
            self.objects.append(_object(element))
            element.clear()
        return element


def read_content(pieces: Iterable[bytes]) -> DocumentContent:
    """What a document lists.

    Args:
        pieces: chunks of its XML, in order.

    Raises:
        Damaged: FreeCAD did not write this.
    """
    reader = _Reader()
    parser = ElementTree.XMLParser(target=reader)
    try:
        for piece in pieces:
            parser.feed(piece)
        parser.close()
    except (ElementTree.ParseError, ValueError, LookupError) as fault:  # the last two: unknown encodings
        raise content_is_damaged(f"no XML: {fault}") from fault
    _check_lists(reader)
    members = tuple(name for each in reader.objects for name in each.members)
    return DocumentContent(tuple(_jobs(reader.objects)), members)


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
        tuple(link.get("value", "") for link in group),
        [each.get("file", "") for each in values if each.get("file")],
    )


def _check_lists(reader: _Reader) -> None:
    """Compare the list of objects with the objects and with their declared count."""
    made = [each.name for each in reader.objects]
    for name in sorted(set(reader.listed) - set(made)):
        raise content_is_damaged(f"the object {name} is listed, and is not there")
    for name in sorted(set(made) - set(reader.listed)):
        raise content_is_damaged(f"the object {name} is not in the list of objects")
    for tag, names in (("Objects", reader.listed), ("ObjectData", made)):
        if reader.counts.get(tag) != str(len(names)) or len(set(names)) < len(names):
            count = reader.counts.get(tag, "no number of")
            raise content_is_damaged(f"{count} objects in <{tag}> announced, {len(set(names))} found")


def _jobs(objects: list[_Object]) -> Iterable[Job]:
    by_name = {each.name: each for each in objects}
    for each in objects:
        if each.proxy == _JOB:
            operations = by_name[each.operations].group if each.operations in by_name else ()
            for name in sorted(set(operations) - set(by_name)):
                raise content_is_damaged(f"the operation {name} of {each.label} is not there")
            yield Job(each.name, each.label, operations)
