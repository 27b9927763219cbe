# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wheel posts documents as an add-on does: what FreeCAD needs of it is in it, and nothing else of its folder is."""

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(Path(__file__).parents[1] / "freecad_app"))

from cam_jobs import add_operation, job_in_reach  # noqa: E402
from test_cli import saved_job  # noqa: E402

from pkm_post.freecad_app.symmetry import create_mirror  # noqa: E402

RUN = "import sys; sys.path.insert(0, sys.argv.pop(1)); from pkm_post.cli import main; sys.exit(main(sys.argv[1:]))"


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """A folder like that of an environment, with what pyproject.toml puts into the wheel, and another's NumPy."""
    folder = tmp_path_factory.mktemp("environment") / "site-packages"
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
    for package in wheel["packages"]:
        shutil.copytree(ROOT / package, folder / package)
    for source, target in wheel["force-include"].items():
        (folder / target).parent.mkdir(parents=True, exist_ok=True)
        copied = shutil.copytree if (ROOT / source).is_dir() else shutil.copy
        copied(ROOT / source, folder / target)
    (folder / "numpy.py").write_text("raise ImportError('NumPy for another Python', name='numpy')")
    return folder


def posted(installed, *arguments):
    return subprocess.run(
        ["python3", "-c", RUN, str(installed), "post", *map(str, arguments)],
        env={name: value for name, value in os.environ.items() if name != "PYTHONPATH"},
        cwd=installed.parent,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=300,
    )


def test_a_document(installed, tmp_path):
    part = saved_job(tmp_path / "part.FCStd")
    ran = posted(installed, part, "--work-offset=0,0,250", "--out", tmp_path / "out")
    assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "out" / "part.pmc").is_file()
    assert str(tmp_path / "out" / "part.pmc") in ran.stdout


def test_a_document_with_objects_of_our_own(installed, tmp_path):
    """Without its class a copy is not known to turn tool axes, and is refused."""
    import FreeCAD as App

    document = App.newDocument("made")
    try:
        job = job_in_reach(document)
        create_mirror(add_operation(job), (0, 1, 0))
        document.recompute()
        document.saveAs(str(tmp_path / "part.FCStd"))
    finally:
        App.closeDocument(document.Name)
    ran = posted(installed, tmp_path / "part.FCStd", "--out", tmp_path / "out")
    assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "out" / "part.pmc").is_file()


def test_a_wheel_that_lacks_what_runs_it_in_freecad(installed, tmp_path):
    lacking = shutil.copytree(installed, tmp_path / "site-packages")
    shutil.rmtree(lacking / "pkm_post" / "tools")
    ran = posted(lacking, saved_job(tmp_path / "part.FCStd"), "--out", tmp_path / "out")
    assert ran.returncode == 1
    assert "error F141" in ran.stderr
