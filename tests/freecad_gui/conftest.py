# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs a scene in a FreeCAD with a window, under Xvfb."""

import functools
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from pictures import painted
from profiles import write_profile

ADDON = Path(__file__).parents[2]
LONGEST_S = 2400
"""The longest scene takes half a minute of the processor, which a busy computer may share with many."""
_XVFB_RUN = ("xvfb-run", "-a", "-s")
_SCREEN = os.environ.get("PKM_SCREEN", "1366x768")
_SCALE = os.environ.get("PKM_SCALE", "1")
"""Of all scenes that ask for nothing else. The processor draws the 3D view: one of 1600x1000 takes it twice as long."""

_REFUSED = re.compile(r"Traceback \(most recent call last\):\n(?:  .*\n)+<class '[\w.]*\.ShownRefused'>")
"""What FreeCAD itself writes of an object that refuses its input: its only way to learn of that is an exception."""


class Scene:
    """What a scene left.

    Attributes:
        folder: its files.
        found: what each of its steps returned, by name.
    """

    def __init__(self, folder, found):
        self.folder, self.found = folder, found

    def __getitem__(self, name):
        return self.found[name]

    def drew(self, name):
        """Whether the picture of a window shows something: more than a twentieth of it is not background."""
        return painted(self.folder / name) > 0.05

    def keep(self, pattern):
        """Put pictures into the folder that PKM_PICTURES names, below the root of the repository, if it names one."""
        if folder := os.environ.get("PKM_PICTURES"):
            for picture in self.folder.glob(pattern):
                shutil.copy(picture, ADDON / folder)


def _first_display():
    """The number at which to look for a free display: two processes that looked at the same one could both take it."""
    return str(100 + os.getpid() % 800)


@pytest.fixture(scope="session")
def scene(tmp_path_factory):
    """Runs a scene by its name, once for all tests; no step of it may end in an exception.

    A screen of another size has one argument more, and pairs of names and values are put into the environment.
    """

    @functools.cache
    def run(name, screen=_SCREEN, environment=()):
        folder, settings = tmp_path_factory.mktemp(name), tmp_path_factory.mktemp("settings")
        write_profile(settings, start_page=False)
        window = shutil.which("freecad") or shutil.which("FreeCAD")
        assert window and shutil.which("xvfb-run"), "FreeCAD's window program and xvfb-run are needed"
        script = Path(__file__).with_name(f"scene_{name}.py")
        command = [*_XVFB_RUN, f"-screen 0 {screen}x24", "-n", _first_display(), window, "-M", str(ADDON), str(script)]
        here = {"PKM_FOLDER": str(folder), "FREECAD_USER_HOME": str(settings), "QT_SCALE_FACTOR": _SCALE}
        how = {
            "env": os.environ | here | dict(environment),
            "capture_output": True,
            "text": True,
        }
        ran = subprocess.run(command, timeout=LONGEST_S, check=False, **how)
        result = folder / "result.json"
        assert result.exists(), ran.stdout + ran.stderr
        found = json.loads(result.read_text())
        report = found.pop("report view")
        said = _REFUSED.sub("", ran.stdout + ran.stderr + report)
        exceptions = [step["exception"] for step in found.values() if "exception" in step]
        assert not exceptions, "\n".join([*exceptions, said])
        assert "Traceback" not in said, said
        return Scene(folder, found)

    return run
