# SPDX-License-Identifier: LGPL-2.1-or-later
"""Mesh file: read a solid from a binary or ASCII STL file as a mesh in mm, or report the faults of the file.

Binary: 80 bytes, the number of triangles, 50 bytes for each; ASCII: ``solid``, then facets of an outer loop of three
vertices, then ``endsolid``; several solids may follow each other. STL states no unit; mm in the work frame {C} are
assumed. Normals and attributes are ignored: the vertex order defines the outside. [STL1988]
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from pkm_post.model import Array, Diagnostic, Diagnostics, Mesh, Phrase, Place
from pkm_post.system import read_fault

SUFFIX = ".stl"
STEP_SUFFIXES = (".step", ".stp")
_HEADER = 84
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_FACET = (
    *("facet", "normal", None, None, None, "outer", "loop"),
    *(("vertex", None, None, None) * 3),
    *("endloop", "endfacet"),
)
"""Tokens of a facet, None for numbers."""
_WORDS = [column for column, word in enumerate(_FACET) if word is not None]
_NUMBERS = [column for column, word in enumerate(_FACET) if word is None]
_NO_TRIANGLES = np.empty((0, 3, 3))
_NAME_LINE = re.compile(rb"^\s*(?:end)?solid\b[^\n]*$", re.IGNORECASE | re.MULTILINE)
_LARGEST_COORDINATE = 1e6
"""mm: coordinates beyond this are rejected as implausible."""

Result = tuple[Mesh | None, Diagnostics]
MESH_READERS: dict[str, Callable[[Path, str], Result]] = {}
"""Readers of other formats by suffix. Inside FreeCAD, ``freecad_app.mesh`` adds STEP."""


def read_mesh(file: str | Path) -> Result:
    """Read the solid of an STL file with mm in the work frame {C}; inside FreeCAD, also of a STEP file."""
    path = Path(file)
    name = os.fsencode(path).decode("utf-8", "replace")
    suffix = path.suffix.lower()
    if suffix in MESH_READERS:
        return MESH_READERS[suffix](path, name)
    if suffix != SUFFIX:
        known = f"expected a name that ends in {' or '.join((SUFFIX, *STEP_SUFFIXES))}"
        found = "STEP files are read only inside FreeCAD" if suffix in STEP_SUFFIXES else known
        return None, (Diagnostic("K138", Place(name), found),)
    try:
        content = path.read_bytes()
    except OSError as fault:
        return None, (read_fault(name, fault),)
    return decode(content, name)


def decode(content: bytes, name: str) -> Result:
    """Decode the solid from the bytes of a file."""
    count = int.from_bytes(content[80:_HEADER], "little")
    if len(content) >= _HEADER and len(content) == _HEADER + count * _RECORD.itemsize:
        triangles = np.frombuffer(content, _RECORD, count, _HEADER)["corners"].astype(np.float64)
    elif re.match(rb"\s*solid\b", content, re.IGNORECASE) and b"\0" not in content:
        triangles, line, found = _ascii(content)
        if found:
            return None, (Diagnostic("K138", Place(name, line=line), found),)
    else:
        stated = f"{count} triangles are {_HEADER + count * _RECORD.itemsize} bytes, the file has {len(content)}"
        found = stated if len(content) >= _HEADER else f"{len(content)} bytes are not an STL file"
        return None, (Diagnostic("K138", Place(name), found),)
    return mesh_of_triangles(triangles, name)


def mesh_of_triangles(triangles: Array, name: str) -> Result:
    """Build a mesh from triangles (T, 3, 3); there must be at least one, with plausible coordinates."""
    if not len(triangles):
        return None, (Diagnostic("K138", Place(name), Phrase("no triangles")),)
    if not np.all(np.abs(triangles) <= _LARGEST_COORDINATE):
        bad = int(np.argmin(np.all(np.abs(triangles) <= _LARGEST_COORDINATE, axis=(1, 2))))
        return None, (Diagnostic("K138", Place(name), Phrase("triangle {} has an implausible coordinate", bad + 1)),)
    # Without its folder the name in messages and certificates is independent of the location of the file.
    return Mesh(Path(name).name, triangles), ()


def _ascii(content: bytes) -> tuple[Array, int, str]:
    """Triangles of ASCII STL; on a mismatch its line and finding."""
    words = np.array(_NAME_LINE.sub(b"", content).lower().split())
    facets, rest = divmod(len(words), len(_FACET))
    table = words[: facets * len(_FACET)].reshape(facets, len(_FACET))
    fits = np.ones(table.shape, dtype=bool)
    for column in _WORDS:
        fits[:, column] = table[:, column] == str(_FACET[column]).encode()
    try:
        values = table[:, _NUMBERS].astype(np.float64)
    except ValueError:
        fits[:, _NUMBERS] = [[_is_number(word) for word in row] for row in table[:, _NUMBERS].tolist()]
    if not fits.all():
        bad = int(np.argmin(fits))
        return _NO_TRIANGLES, *_location(content, bad, _FACET[bad % len(_FACET)] or "a number")
    if rest:
        return _NO_TRIANGLES, *_location(content, len(words) - 1, "a whole facet")
    return values[:, 3:].reshape(-1, 3, 3), 0, ""


def _location(content: bytes, number: int, expected: str) -> tuple[int, str]:
    """The line of the token with a number, and the finding there."""
    before = 0
    for line, text in enumerate(content.split(b"\n"), start=1):
        words = _NAME_LINE.sub(b"", text).split()
        if before + len(words) > number:
            word = words[number - before].decode("ascii", "replace")
            return line, f"expected {expected}, got {word!r}"
        before += len(words)
    return 0, f"expected {expected}"


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
