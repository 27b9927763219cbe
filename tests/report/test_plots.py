# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses
import sys

import numpy as np
import pytest
from pictures import painted
from programs import cone

from pkm_post.machine import machine_named
from pkm_post.options import PICTURE, Options
from pkm_post.posting.steps import post
from pkm_post.report import plots
from pkm_post.report.plots import _only, draw_reach


def test_runs_of_chosen_points_are_drawn_without_those_between():
    points = np.arange(24.0).reshape(8, 3)
    chosen = np.array([False, True, True, False, False, False, True, True])
    x, _, _ = _only(points, chosen)
    np.testing.assert_array_equal(x, [3, 6, np.nan, 18, 21])


WITH_PICTURE = Options(also=(PICTURE,))
NO_MATHEMATICS = "$x^_$ \\frac{ 日本"
"""What matplotlib would take for mathematics, and what its font does not have."""


@pytest.mark.slow
def test_a_picture_shows_names_as_they_are(tmp_path):
    made = cone()
    named = dataclasses.replace(
        made, source=f"{NO_MATHEMATICS}.ngc", operations=tuple(f"{NO_MATHEMATICS} {name}" for name in made.operations)
    )
    machine = dataclasses.replace(machine_named("example_6tps")[0], name=NO_MATHEMATICS)
    assert post(named, machine, tmp_path / "part.pmc", WITH_PICTURE).diagnostics == ()
    assert 0.02 < painted(tmp_path / "part-report.png") < 0.5


def test_the_picture_of_a_report_has_its_axes_lines_and_legends(tmp_path, monkeypatch):
    figures = []
    monkeypatch.setattr(plots, "save", lambda figure, path, **how: figures.append(figure) or path.touch())
    machine = machine_named("example_6tps")[0]
    program = cone()
    post(program, machine, tmp_path / "part.pmc", WITH_PICTURE)
    (figure,) = figures
    path, lengths, speeds, deviations = figure.get_axes()
    assert [axes.get_ylabel() for axes in (lengths, speeds, deviations)] == [
        "strut length mm", "strut speed mm/s", "deviation by tolerance",
    ]  # fmt: skip
    legends = [[text.get_text() for text in axes.get_legend().get_texts()] for axes in (path, lengths, deviations)]
    assert legends == [[*program.operations, "rapid"], [f"strut {n}" for n in range(1, 7)], ["tip", "axis"]]
    limits = [line.get_ydata()[0] for line in lengths.lines[6:]]
    assert limits == list(machine.strut_stroke)
    assert deviations.lines[0].get_ydata().max() <= 1.0
    assert program.source in figure.get_suptitle() and machine.name in figure.get_suptitle()


def test_a_reach_map_shows_the_name_of_the_machine_as_it_is(tmp_path):
    tip = np.array([[x, y, 200.0] for x in (0.0, 50.0) for y in (0.0, 50.0)])
    assert draw_reach(tmp_path / "map.png", NO_MATHEMATICS, tip, np.full(4, 0.5)) == ()
    assert 0.02 < painted(tmp_path / "map.png") < 0.9


class Broken:
    """An installation whose import raises."""

    def __init__(self, fault):
        self._fault = fault

    def find_spec(self, name, path=None, target=None):
        if name.startswith("matplotlib"):
            raise self._fault


BROKEN = (
    ModuleNotFoundError("No module named 'matplotlib'"),
    ImportError("numpy.core.multiarray failed to import"),
    AttributeError("_ARRAY_API not found"),
    ValueError("numpy.dtype size changed, may indicate binary incompatibility"),
    RuntimeError("module was compiled against API version 0x10"),
)


@pytest.mark.slow
@pytest.mark.parametrize("fault", BROKEN, ids=lambda fault: type(fault).__name__)
def test_a_matplotlib_that_cannot_be_imported_costs_the_picture_alone(tmp_path, monkeypatch, fault):
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(sys, "meta_path", [Broken(fault), *sys.meta_path])
    machine, _ = machine_named("example_6tps")
    posted = post(cone(), machine, tmp_path / "part.pmc", WITH_PICTURE)
    (warning,) = [each for each in posted.diagnostics if each.code == "F102"]
    assert warning.found == f"{type(fault).__name__}: {fault}"
    names = {path.name for path in tmp_path.iterdir()}
    assert {"part.pmc", "part.pkmt", "part-report.json"} <= names and "part-report.png" not in names
