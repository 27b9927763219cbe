# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line begins in any Python: posting a document goes on inside FreeCAD, which has NumPy."""

import os
import subprocess
from pathlib import Path

import pytest

ADDON = Path(__file__).parents[2]
RUN = """
import sys
sys.modules["numpy"] = None  # an import of it is a ModuleNotFoundError now
from pkm_post.cli import main
main(sys.argv[1:])
"""


@pytest.mark.parametrize("words", ["", "post", "reach", "verify", "check", "pmac jog", "pmac mdi", "pmac continue"])
def test_arguments_are_explained_without_numpy(words):
    command = ["python3", "-c", RUN, *words.split(), "--help"]
    found = os.environ | {"PYTHONPATH": str(ADDON)}
    ran = subprocess.run(command, env=found, capture_output=True, text=True, timeout=300, check=False)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.startswith("usage:")


@pytest.mark.parametrize("words", ["post a.FCStd --work-offset=0,0,250 --tool-length 1=120", "reach a.FCStd"])
def test_the_arguments_of_a_document_are_taken_without_numpy(words):
    run = RUN.replace("import main", "import _parser").replace(
        "main(sys.argv[1:])", "_parser().parse_args(sys.argv[1:])"
    )
    found = os.environ | {"PYTHONPATH": str(ADDON)}
    command = ["python3", "-c", run, *words.split()]
    ran = subprocess.run(command, env=found, capture_output=True, text=True, timeout=300, check=False)
    assert ran.returncode == 0, ran.stderr


@pytest.mark.parametrize("words", ["post a.ngc", "check a.ngc", "machine list", "batch jobs.toml"])
def test_what_cannot_go_on_without_numpy_says_so_in_one_line(words):
    """With the command that installs it, as for an optional package."""
    found = os.environ | {"PYTHONPATH": str(ADDON)}
    command = ["python3", "-c", RUN.replace("main(sys", "sys.exit(main(sys") + ")", *words.split()]
    ran = subprocess.run(command, env=found, capture_output=True, text=True, timeout=300, check=False)
    assert ran.returncode == 1
    (line,) = ran.stderr.splitlines()
    assert line.startswith("PKM Post needs NumPy: type: ") and line.endswith("numpy")
