# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trajectory files that lie under right checksums; `python3 tests/lying_trajectories.py SECONDS` verifies many.

Enters: the bytes of a file that was posted, and a generator. Leaves: the bytes with one to three fields of any record
changed to what damages most, and what was changed. A number of the generator gives the same lie again.
"""

import contextlib
import io
import random
import sys
import tempfile
import time
import warnings
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [path for path in (str(HERE.parent), str(HERE / "writing" / "trajectory_file")) if path not in sys.path]

import numpy as np  # noqa: E402 - the path comes first
from made_files import header_of, sealed  # noqa: E402

from pkm_post.cli import main  # noqa: E402
from pkm_post.writing.trajectory_file.layout import HEADER, TABLES  # noqa: E402

GCODE = """T1 M6
S1000 M3
G64 P0.02
G0 X0 Y0 Z60
G1 X10 F600
G2 X20 Y0 I5 J0
G3 X20 Y10 Z58 I0 J5
T2 M6
S900 M3
G4 P1
G1 X0 Y0 Z60 F300
X10
X20
M5
M2
"""
LENGTHS = ["--tool-length", "1=120", "--tool-length", "2=110"]
NUMBERS = (0.0, -0.0, -1.0, 1.0, 7.0, 100.0, 1e5, 1e9, -1e9, 1e300, 1e-3, 1e-9, 1e-300, 5e-324, np.nan, np.inf, -np.inf)
SCALES = (2.0, 0.5, -1.0, 1e6, 1e-6, 1 + 1e-4)


def lie(rng, content):
    """The content with fields that lie, under right checksums, and what was done: (table, record, field, value)."""
    content, done = bytearray(content), []
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        table = rng.choice(["header", *(name for name in TABLES if name != "text")])
        record = HEADER if table == "header" else TABLES[table]
        begin, count, size = (0, 1, HEADER.itemsize) if table == "header" else header_of(bytes(content))[table].item()
        if not count or begin + count * size > len(content) or size != record.itemsize:
            continue  # an earlier lie was about this table
        field, row = rng.choice(record.names), rng.randrange(count)
        dtype, offset = record.fields[field][:2]
        base = np.dtype("<u8") if dtype.base.fields else dtype.base
        at = begin + row * size + offset + base.itemsize * rng.randrange(dtype.itemsize // base.itemsize)
        old = np.frombuffer(bytes(content), base, 1, at)[0]
        value = _another(rng, base, old)
        content[at : at + base.itemsize] = value.tobytes()
        done.append((table, row, field, value))
    return sealed(content) if int.from_bytes(content[12:16], "little") == HEADER.itemsize else bytes(content), done


def _another(rng, base, old):
    """Another value of a field."""
    if base.kind == "f":
        return np.array(rng.choice([*NUMBERS, *(float(old) * scale for scale in SCALES)]), base)
    if base.kind == "S":
        return np.array(rng.choice([b"", b"PKMT", b"\xff" * 8]), base)
    info = np.iinfo(base)
    value = rng.choice([0, 1, 2, 3, 255, info.min, info.max, int(old) + 1, int(old) - 1])
    return np.array(min(max(value, int(info.min)), int(info.max)), base)


def posted(folder):
    """Post a program with arcs, two tools and waits; the paths of the motion program and of the trajectory."""
    file = folder / "part.ngc"
    file.write_text(GCODE, encoding="ascii")
    with contextlib.redirect_stdout(io.StringIO()):
        assert main(["post", str(file), *LENGTHS, "--out", str(folder / "out")]) == 0
    (folder / "out" / "part-manifest.json").unlink()  # it would see every change
    return folder / "out" / "part.pmc", folder / "out" / "part.pkmt"


def verified(program, trajectory, content):
    """Exit code and diagnostics of ``verify`` with a trajectory of this content; warnings of NumPy are raised."""
    trajectory.write_bytes(content)
    reported = io.StringIO()
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(reported):
        warnings.simplefilter("error")
        code = main(["verify", str(program), "--against", str(trajectory)])
    return code, reported.getvalue()


def is_refused_by_name(code, reported):
    """Whether something was refused, in diagnostics alone."""
    lines = [line for line in reported.splitlines() if ": warning F107: " not in line]
    return code == 1 and bool(lines) and all(": error " in line for line in lines)


def series(seconds):
    """Lie for so long; how often, and how often it was refused."""
    count = refused = 0
    with tempfile.TemporaryDirectory() as folder:
        program, trajectory = posted(Path(folder))
        sound, end = trajectory.read_bytes(), time.monotonic() + seconds
        while time.monotonic() < end:
            content, done = lie(random.Random(count), sound)
            begin = time.monotonic()
            code, reported = verified(program, trajectory, content)
            if not (code == 0 or is_refused_by_name(code, reported)) or time.monotonic() - begin > 10:
                raise SystemExit(f"seed {count}, {done}: exit code {code}, {reported}")
            count, refused = count + 1, refused + code
    return count, refused


if __name__ == "__main__":
    print("{} lies, {} of them refused, the others change nothing that is run".format(*series(float(sys.argv[1]))))
