# SPDX-License-Identifier: LGPL-2.1-or-later
"""Manifest: which files one posting made, with a fingerprint of each, so that no reader takes files of two postings.

A folder with the results of a posting enters; ``STEM-manifest.json`` beside them leaves. Later any of the results
enters; the manifest leaves, if every file that it lists is there and is still the same, or what is wrong.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

import pkm_post
from pkm_post.model import Diagnostic, Place

Findings = tuple[Diagnostic, ...]

ENDING = "-manifest.json"
"""How the name of a manifest goes on behind the stem of the results."""
_FORMAT = 1
_BINARY = (".pkmt", ".png")
"""Suffixes of results that are no text."""
_MOST_BYTES = 1 << 24
"""Of a manifest that is read: a hundred thousand parts of a program need less."""
_AT_ONCE = 1 << 20
"""Bytes in one pass."""
_FINGERPRINT = re.compile("[0-9a-f]{64}")


@dataclass(frozen=True)
class Manifest:
    """What one posting made.

    Attributes:
        path: of the manifest; the results lie beside it.
        files: fingerprints by name.
    """

    path: Path
    files: Mapping[str, str]

    def fingerprint_of(self, name: str) -> str | None:
        """What is listed for a name; capital and small letters are the same, as on Windows. None where nothing is."""
        found = {listed.casefold(): fingerprint for listed, fingerprint in self.files.items()}
        return found.get(name.casefold())


class _UnreadableError(Exception):
    """What is wrong with a manifest."""


def manifest_name(stem: str) -> str:
    """The name of the manifest of results with this stem."""
    return stem + ENDING


def write(folder: Path, stem: str) -> None:
    """Write the manifest of all files in a folder into it; the same files give the same bytes."""
    files = {path.name: fingerprint_of_file(path) for path in sorted(folder.iterdir())}
    content = {"format": _FORMAT, "product": f"PKM Post {pkm_post.__version__}", "files": files}
    text = json.dumps(content, indent=2) + "\n"
    (folder / manifest_name(stem)).write_text(text, encoding="ascii", newline="\n")


def listed(folder: Path, stem: str) -> tuple[str, ...]:
    """The names of the results in a folder that an earlier posting made; none where it left no manifest."""
    try:
        return tuple(_read(folder / manifest_name(stem)).files)
    except (OSError, _UnreadableError):  # readers of the results refuse them for it
        return ()


def check(file: Path) -> tuple[Manifest | None, Findings]:
    """The manifest that lists a result, with every listed file there and unchanged.

    Returns:
        The manifest and no finding, or None and why: F106 where a listed file is missing or has changed, F108 where the
        manifest cannot be read, and the warning F107 where no manifest lists the file.
    """
    for path in _manifests_near(file):
        try:
            manifest = _read(path)
        except (OSError, _UnreadableError) as fault:
            return None, (Diagnostic("F108", Place(str(path)), str(fault)),)
        if manifest.fingerprint_of(file.name):
            wrong = ", ".join(_differences(manifest))
            return (None, (Diagnostic("F106", Place(str(path)), wrong),)) if wrong else (manifest, ())
    return None, (Diagnostic("F107", Place(str(file)), f"no {manifest_name('...')} beside it lists it"),)


def fingerprint_of_file(file: Path) -> str:
    """The fingerprint of a result on disk; see ``fingerprint``."""
    with file.open("rb") as stream:
        return _fingerprint(file.name, stream)


def fingerprint(name: str, content: bytes) -> str:
    """The SHA-256 of a result, in hexadecimal digits.

    Line ends of a text count as LF: CAM writes programs with CR LF on Windows, and they mean the same.

    Args:
        name: of the result; its suffix says whether it is a text.
        content: its bytes.
    """
    return _fingerprint(name, BytesIO(content))


def _fingerprint(name: str, stream: BinaryIO) -> str:
    is_text = not name.lower().endswith(_BINARY)
    digest = hashlib.sha256()
    for part in _parts(stream):
        has_line_ends = is_text and b"\r" in part  # to look for one byte is much faster than for two
        digest.update(part.replace(b"\r\n", b"\n") if has_line_ends else part)
    return digest.hexdigest()


def _parts(stream: BinaryIO) -> Iterator[bytes]:
    """The bytes of a stream, part by part; a CR stays with the LF behind it."""
    while part := stream.read(_AT_ONCE):
        while part.endswith(b"\r") and (more := stream.read(1)):
            part += more
        yield part


def _manifests_near(file: Path) -> list[Path]:
    """The manifests beside a file whose stems begin its name, the longest first."""
    name = file.name.casefold()
    found = [path for path in file.parent.glob("*" + ENDING) if name.startswith(_stem(path).casefold())]
    return sorted(found, key=lambda path: len(path.name), reverse=True)


def _stem(manifest: Path) -> str:
    return manifest.name.removesuffix(ENDING)


def _read(path: Path) -> Manifest:
    """A manifest from its file.

    Raises:
        _UnreadableError: it is not as ``write`` makes it.
    """
    with path.open("rb") as stream:
        text = stream.read(_MOST_BYTES + 1)
    if len(text) > _MOST_BYTES:
        raise _UnreadableError(f"it has more than {_MOST_BYTES} bytes")
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as fault:
        raise _UnreadableError(f"it is no JSON ({fault})") from fault
    if not isinstance(content, dict) or content.get("format") != _FORMAT:
        raise _UnreadableError(f"it is not of format {_FORMAT}")
    files = content.get("files")
    if not isinstance(files, dict) or not all(map(_is_entry, files, files.values())):
        raise _UnreadableError("its files are not names with fingerprints")
    return Manifest(path, files)


def _is_entry(name: str, fingerprint: object) -> bool:
    """Whether this is the name of a file beside the manifest, and a fingerprint."""
    is_name = not re.search(r"[/\\:\0]", name) and name not in ("", ".", "..")
    return is_name and isinstance(fingerprint, str) and _FINGERPRINT.fullmatch(fingerprint) is not None


def _differences(manifest: Manifest) -> Iterator[str]:
    """Which of the listed files are not as they were, in words."""
    for name, listed in manifest.files.items():
        try:
            found = fingerprint_of_file(manifest.path.with_name(name))
        except FileNotFoundError:
            yield f"{name} is missing"
        except OSError as fault:
            yield f"{name} cannot be read ({fault.strerror})"
        else:
            if found != listed:
                yield f"{name} has changed"
