# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fuzz the readers of part programs with bytes that grow towards new branches of their code; run by ``make fuzz``.

Whatever the bytes, a reader gives a program or diagnostics: an exception, a hang or memory without bound is a fault.
The first byte chooses the reader; execution is bounded so that a loop in the input is no hang.
"""

import sys
import tempfile
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["pkm_post"]):
    from pkm_post.reading import cldata, gcode

AXIS_WORDS = sorted(gcode.options.AXIS_WORDS)
BOUNDED = gcode.ExecutionLimits(blocks=2000, operations=20000)


def read(data: bytes) -> None:
    """Read the bytes and check what comes back."""
    if not data:
        return
    choice, text = data[0], data[1:]
    if choice % 2:
        words = AXIS_WORDS[choice // 2 % len(AXIS_WORDS)]
        program, diagnostics = gcode.read(text, "fuzz.ngc", gcode.ReadOptions(axis_words=words), BOUNDED)
    else:
        program, diagnostics = cldata.read(text, "fuzz.cl")
    if program is None and not diagnostics:
        raise AssertionError("neither a program nor a diagnostic")


def seeds(folder: Path) -> None:
    """Bad programs of the tests, each with the byte that chooses its reader, to begin with."""
    for kind, choice in (("bad_gcode", b"\1"), ("bad_gcode_meaning", b"\1"), ("bad_cldata", b"\0")):
        for file in (Path(__file__).parents[1] / "tests" / "data" / kind).iterdir():
            (folder / f"{kind}-{file.name}").write_bytes(choice + file.read_bytes())


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as corpus:
        seeds(Path(corpus))
        atheris.Setup([*sys.argv, corpus], read)
        atheris.Fuzz()
