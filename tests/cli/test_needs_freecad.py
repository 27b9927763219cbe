# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which commands go into FreeCAD: those with documents, and with solids in STEP."""

from pathlib import Path

import pytest

from pkm_post.cli import processes


@pytest.mark.parametrize(
    ("files", "solids", "needed"),
    [
        (["a.ngc"], [], False),
        (["a.ngc", "b.FCStd"], [], True),
        (["a.cls"], ["wall.stl", "none"], False),
        (["a.cls"], ["wall.stl", "vice.STP"], True),
        (["a.cls"], ["wall.step"], True),
    ],
)
def test_names_say_it(monkeypatch, files, solids, needed):
    monkeypatch.setattr(processes, "is_inside", lambda: False)
    assert processes.needs_freecad([Path(file) for file in files], solids) is needed


def test_nothing_is_needed_inside(monkeypatch):
    monkeypatch.setattr(processes, "is_inside", lambda: True)
    assert not processes.needs_freecad([Path("a.FCStd")], ["wall.step"])
