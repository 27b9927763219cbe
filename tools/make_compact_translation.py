# SPDX-License-Identifier: LGPL-2.1-or-later
"""Leave out of a compiled translation (.qm) what Qt does not need to look a text up: two fifths of its bytes.

    python3 tools/make_compact_translation.py resources/translations/pkm_post_zh-CN.qm

Qt finds a message by a hash of the English text, then compares context, English text and comment, as far as they are
there. ``lrelease -compress`` should leave them out where the hash suffices, but writes them all. Context remains, and
the English text where FreeCAD's own texts have the same context, or where two texts have the same hash.
"""

import struct
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

MAGIC = bytes.fromhex("3cb86418caef9c95cd211cbf60a1bddd")
HASHES, MESSAGES = 0x42, 0x69
END, TRANSLATION, TEXT, CONTEXT = 1, 3, 6, 7
SHARED_CONTEXTS = (b"App::Property", b"Workbench")


def sections(compiled: bytes) -> dict[int, bytes]:
    """The content of each section by its tag, in the order of the file."""
    if not compiled.startswith(MAGIC):
        raise ValueError("expected a compiled Qt translation")
    found, at = {}, len(MAGIC)
    while at < len(compiled):
        tag, size = struct.unpack_from(">BI", compiled, at)
        found[tag] = compiled[at + 5 : at + 5 + size]
        at += 5 + size
    return found


def message(messages: bytes, at: int) -> Iterator[tuple[int, bytes]]:
    """Tag and content of each field of the message at an offset."""
    while messages[at] != END:
        tag, size = struct.unpack_from(">BI", messages, at)
        yield tag, messages[at + 5 : at + 5 + size]
        at += 5 + size


def compact(compiled: bytes) -> bytes:
    """The same translation without what the lookup does not need."""
    found = sections(compiled)
    rows = list(struct.iter_unpack(">II", found[HASHES]))
    times = Counter(number for number, _ in rows)
    hashes, messages = bytearray(), bytearray()
    for number, offset in rows:
        fields = list(message(found[MESSAGES], offset))
        alone = times[number] == 1 and dict(fields)[CONTEXT] not in SHARED_CONTEXTS
        kept = (TRANSLATION, CONTEXT) if alone else (TRANSLATION, TEXT, CONTEXT)
        hashes += struct.pack(">II", number, len(messages))
        for tag, content in fields:
            if tag in kept:
                messages += struct.pack(">BI", tag, len(content)) + content
        messages.append(END)
    found |= {HASHES: bytes(hashes), MESSAGES: bytes(messages)}
    return MAGIC + b"".join(struct.pack(">BI", tag, len(content)) + content for tag, content in found.items())


if __name__ == "__main__":
    for name in sys.argv[1:]:
        Path(name).write_bytes(compact(Path(name).read_bytes()))
