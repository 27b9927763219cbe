# SPDX-License-Identifier: LGPL-2.1-or-later
"""Manifest: files of one posting with their fingerprints, to detect files of different postings.

Writing: from a folder with the results of a posting to ``STEM-manifest.json`` beside them. Checking: from any result to
its manifest, if every listed file is present and unchanged, or to the fault.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from io import BytesIO
from pathlib import Path
from types import MappingProxyType
from typing import BinaryIO, NamedTuple

import pkm_post
from pkm_post.model import Diagnostic, Diagnostics, Place, checkpoint
from pkm_post.system import result_files

ENDING = result_files.MANIFEST
"""Ending of a manifest name after the stem of the results."""
_FORMAT = 1
_BINARY = (result_files.TRAJECTORY, ".png")
"""Suffixes of binary results."""
_MOST_BYTES = 1 << 24
"""Largest manifest that is read: enough for a hundred thousand program parts."""
_AT_ONCE = 1 << 20
"""Bytes per pass."""
_FINGERPRINT = re.compile("[0-9a-f]{64}")


class Manifest(NamedTuple):
    """Files of one posting.

    Attributes:
        path: of the manifest; the results are in the same folder.
        files: fingerprints by name.
    """

    path: Path
    files: Mapping[str, str]

    def fingerprint_of(self, name: str) -> str | None:
        """Fingerprint listed for a name, case-insensitive as on Windows, or None."""
        found = {listed.casefold(): fingerprint for listed, fingerprint in self.files.items()}
        return found.get(name.casefold())


class _UnreadableError(Exception):
    """Fault of a manifest."""


def manifest_name(stem: str) -> str:
    """Name of the manifest of results with this stem."""
    return stem + ENDING


def write(folder: Path, stem: str, known: Mapping[str, str] = MappingProxyType({})) -> None:
    """Write the manifest of all files in a folder of results with one stem into it; equal files yield equal bytes.

    ``known`` are fingerprints of large files that were computed before, by name.
    """
    files = {path.name: known.get(path.name) or fingerprint_of_file(path) for path in sorted(folder.iterdir())}
    content = {"format": _FORMAT, "product": f"PKM Post {pkm_post.__version__}", "files": files}
    text = json.dumps(content, indent=2) + "\n"
    (folder / manifest_name(stem)).write_text(text, encoding="ascii", newline="\n")


def listed(folder: Path, stem: str) -> tuple[str, ...]:
    """Names of the results that an earlier posting left in a folder; empty without a manifest."""
    try:
        return tuple(_read(folder / manifest_name(stem)).files)
    except (OSError, _UnreadableError):  # readers of the results refuse such a manifest
        return ()


def check(file: Path) -> tuple[Manifest | None, Diagnostics]:
    """Find the manifest that lists a result, and verify that every listed file is present and unchanged.

    Returns:
        The manifest and no finding, or None and the reason: F106 where a listed file is missing or has changed, F108
        where the manifest cannot be read, and the warning F107 where no manifest lists the file.
    """
    for path in _candidate_manifests(file):
        try:
            manifest = _read(path)
        except (OSError, _UnreadableError) as fault:
            return None, (Diagnostic("F108", Place(str(path)), str(fault)),)
        if manifest.fingerprint_of(file.name):
            wrong = ", ".join(_differences(manifest))
            return (None, (Diagnostic("F106", Place(str(path)), wrong),)) if wrong else (manifest, ())
    return None, (Diagnostic("F107", Place(str(file)), f"no {manifest_name('...')} beside it lists it"),)


def fingerprint_of_file(file: Path) -> str:
    """Fingerprint of a result on disk; see ``fingerprint``."""
    with file.open("rb") as stream:
        return _fingerprint(file.name, stream)


def fingerprint(name: str, content: bytes) -> str:
    """SHA-256 of a result, in hexadecimal digits; the suffix of its name identifies text files.

    Line ends of a text are normalised to LF: CAM writes programs with CR LF on Windows, which are equivalent.
    """
    return _fingerprint(name, BytesIO(content))


def _fingerprint(name: str, stream: BinaryIO) -> str:
    is_text = not name.lower().endswith(_BINARY)
    digest = hashlib.sha256()
    for part in _parts(stream):
        has_line_ends = is_text and b"\r" in part  # searching for one byte is much faster than for two
        digest.update(part.replace(b"\r\n", b"\n") if has_line_ends else part)
    return digest.hexdigest()


def _parts(stream: BinaryIO) -> Iterator[bytes]:
    """Yield the bytes of a stream in parts; a CR stays with the LF after it."""
    while part := stream.read(_AT_ONCE):
        checkpoint()
        while part.endswith(b"\r") and (more := stream.read(1)):
            part += more
        yield part


def _candidate_manifests(file: Path) -> list[Path]:
    """Manifests beside a file whose stem is a prefix of its name, the longest first."""
    name = file.name.casefold()
    found = [
        path for path in file.parent.glob("*" + ENDING) if name.startswith(path.name.removesuffix(ENDING).casefold())
    ]
    return sorted(found, key=lambda path: len(path.name), reverse=True)


def _read(path: Path) -> Manifest:
    """Read a manifest file.

    Raises:
        _UnreadableError: it does not have the format of ``write``.
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
    """Messages on listed files that are missing or have changed."""
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
