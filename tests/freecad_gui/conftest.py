# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs scenes in a FreeCAD with a window, under Xvfb."""

import functools
import json
import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest
from pictures import painted

ADDON = Path(__file__).parents[2]
LONGEST_S = 2400
"""The longest scene takes half a minute of the processor, which a busy computer may share with many."""
_LOOK_S = 0.05
"""Between two looks for the result of a scene."""
_PATIENCE_S = 20
"""With a window that is to end."""
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


class Window:
    """A FreeCAD with a window under Xvfb, which runs scenes one after the other.

    Args:
        folder: for what it says.
        screen: width and height, such as "1366x768".
        environment: names and values of variables.
    """

    def __init__(self, folder, screen=_SCREEN, environment=()):
        program = shutil.which("freecad") or shutil.which("FreeCAD")
        assert program and shutil.which("xvfb-run"), "FreeCAD's window program and xvfb-run are needed"
        script = Path(__file__).with_name("window.py")
        command = [*_XVFB_RUN, f"-screen 0 {screen}x24", "-n", _first_display(), program, "-M", str(ADDON), str(script)]
        self._output = (folder / "said.txt").open("w+", encoding="utf-8", errors="replace")
        self._process = subprocess.Popen(
            command,
            env=os.environ | {"PKM_FOLDER": str(folder), "QT_SCALE_FACTOR": _SCALE} | dict(environment),
            stdin=subprocess.PIPE,
            stdout=self._output,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )

    def run(self, name, folder, others_follow=False):
        """Run a scene by its name; what its steps found, and all that it said.

        Args:
            name: of the scene.
            folder: for what it writes.
            others_follow: whether the window is put in order for others.

        Raises:
            AssertionError: it left no result.
        """
        before, result = self._output.seek(0, os.SEEK_END), folder / "result.json"
        script = Path(__file__).with_name(f"scene_{name}.py")
        self._process.stdin.write(json.dumps([str(script), str(folder), others_follow]) + "\n")
        self._process.stdin.flush()
        end = time.monotonic() + LONGEST_S
        while not result.exists() and self._process.poll() is None and time.monotonic() < end:
            time.sleep(_LOOK_S)
        self._output.seek(before)
        said = self._output.read()
        assert result.exists(), said
        found = json.loads(result.read_text())
        return found, said + found.pop("report view")

    def close(self):
        """End it."""
        self._process.stdin.close()
        try:
            self._process.wait(_PATIENCE_S)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, signal.SIGKILL)  # the X server and FreeCAD as well
            self._process.wait()
        self._output.close()


SHARED = []
"""The window of the scenes that need no other, while it is open."""


def _of_shared_window(name, folder):
    """Run a scene in the window that was opened for an earlier one, if that left it in order."""
    window = SHARED.pop() if SHARED else Window(folder)
    try:
        found, said = window.run(name, folder, others_follow=True)
        _require_no_fault(found, said)
    except BaseException:
        window.close()
        raise
    SHARED.append(window)
    return found


def _require_no_fault(found, said):
    exceptions = [step["exception"] for step in found.values() if "exception" in step]
    assert not exceptions, "\n".join(exceptions)
    said = _REFUSED.sub("", said)
    assert "Traceback" not in said, said


def pytest_runtest_teardown(item, nextitem):
    """Close the window behind the last test that may use it."""
    if SHARED and (nextitem is None or nextitem.path.parent != item.path.parent):
        SHARED.pop().close()


@pytest.fixture(scope="session")
def scene(tmp_path_factory):
    """Runs a scene by its name, once for all tests; no step of it may end in an exception.

    A scene has a FreeCAD of its own if its tests ask for that, or for a screen of another size, or for pairs of names
    and values in the environment; otherwise it shares one with others.
    """

    @functools.cache
    def run(name, screen=_SCREEN, environment=(), alone="PKM_PICTURES" in os.environ):
        folder = tmp_path_factory.mktemp(name)
        if not (alone or environment or screen != _SCREEN):
            return Scene(folder, _of_shared_window(name, folder))
        window = Window(folder, screen, environment)
        try:
            found, said = window.run(name, folder)
        finally:
            window.close()
        _require_no_fault(found, said)
        return Scene(folder, found)

    return run
