# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compile the Kaitai description of the trajectory file, and compare what its parser reads with what Python reads.

    python3 tests/writing/trajectory_file/conformance.py FOLDER

FOLDER has the packages of npm in node_modules; `make conformance` puts them there. Ends with 1 when anything differs.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(ROOT), str(HERE), str(HERE.parents[1])]

from made_files import newer  # noqa: E402 - the path comes first
from plain_text import lines_of  # noqa: E402
from trajectories import random_trajectory  # noqa: E402

from pkm_post.writing.trajectory_file import write  # noqa: E402

DESCRIPTION = ROOT / "resources" / "trajectory" / "pkmt.ksy"


def parsed(modules, file):
    """What the compiled parser reads, by line; or why it does not."""
    command = ["node", HERE / "conformance.js", modules, DESCRIPTION, file]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def same(found, expected):
    """Whether two words are the same, or the same number."""
    if found == expected:
        return True
    try:
        return float(found) == float(expected)
    except ValueError:
        return False


def difference(found, expected):
    """The first two lines that differ, if any do."""
    for number, lines in enumerate(zip(found, expected, strict=False)):
        words = [line.split(" ") for line in lines]
        if len(words[0]) != len(words[1]) or not all(map(same, *words)):
            return f"line {number}:\n  {lines[0]}\n  {lines[1]}"
    return None if len(found) == len(expected) else f"{len(found)} lines, expected {len(expected)}"


def made(file):
    """Write files of several lengths in turn, each also as a minor version to come would write it."""
    for seed, count in enumerate((0, 1, 20, 500)):
        write(random_trajectory(seed, count), file)
        yield
        file.write_bytes(newer(file.read_bytes()))
        yield


def check(modules, folder):
    """What is wrong, in words, or None; and how many lines were the same."""
    file, lines = folder / "part.pkmt", 0
    for _ in made(file):
        run, expected = parsed(modules, file), list(lines_of(file.read_bytes()))
        fault = run.stderr if run.returncode else difference(run.stdout.splitlines(), expected)
        if fault:
            return fault, lines
        lines += len(expected)
    content = bytearray(file.read_bytes())
    content[8] += 1
    file.write_bytes(content)
    if "ValidationNotEqualError" not in parsed(modules, file).stderr:
        return "a file of another major version is read", lines
    return None, lines


def main():
    """Check and report."""
    with tempfile.TemporaryDirectory() as folder:
        fault, lines = check(Path(sys.argv[1], "node_modules").resolve(), Path(folder))
    if fault:
        raise SystemExit(f"pkmt.ksy does not describe the files: {fault}")
    print(f"pkmt.ksy compiles, and its parser reads what Python reads: {lines} records")


if __name__ == "__main__":
    main()
