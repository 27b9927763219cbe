# SPDX-License-Identifier: LGPL-2.1-or-later
"""The material of a simulated job: its tools and poses, against booleans of OpenCASCADE."""

import math
from dataclasses import replace

import FreeCAD as App
import numpy as np
import Part
import pytest
from cam_jobs import add_operation, job_in_reach
from machines import text_without_jerk
from meshes import box

from pkm_post.freecad_app.material import can_be_cut, cutting_part, material_of, step_of
from pkm_post.freecad_app.simulation import simulate_job
from pkm_post.model import Mesh, Shank, Tool
from pkm_post.removal import Stock

TILT = math.radians(30)
AXIS = f"I{math.sin(TILT)} J0 K{math.cos(TILT)}"
PLUNGE = ["G0 X10 Y10 Z40 I0 J0 K1", f"G0 X20 Y10 Z35 {AXIS}", f"G1 X12 Y10 Z13 {AXIS} F10", f"G0 X20 Y10 Z35 {AXIS}"]
CUBE = 20.0


def tool_job(document):
    job = job_in_reach(document)
    for side in ("Xneg", "Xpos", "Yneg", "Ypos", "Zneg", "Zpos"):
        setattr(job.Stock, f"Ext{side}", 0)
    tool = job.Tools.Group[0].Tool
    tool.Diameter, tool.CuttingEdgeHeight, tool.ShankDiameter = 8, 30, 8
    return job


def solid_of(radius, corner, top, tip, axis):
    """A ball or flat end mill by OpenCASCADE."""
    start = App.Vector(*tip) + App.Vector(*axis) * corner
    body = Part.makeCylinder(radius, top - corner, start, App.Vector(*axis))
    return body.fuse(Part.makeSphere(radius, start)) if corner else body


@pytest.mark.parametrize("corner", [0.0, 4.0])
def test_one_tilted_pose_takes_what_a_boolean_takes(corner):
    axis = np.array([math.sin(TILT) * 0.6, math.sin(TILT) * 0.8, math.cos(TILT)])
    tip = np.array([9.0, 11.0, 13.0])
    cube = Part.makeBox(CUBE, CUBE, CUBE)
    stock = Stock.of(box([0, 0, 0], [CUBE] * 3), 0.5)
    before = stock.volume
    for _ in stock.cut(tip[None], axis[None], cutting_part(Tool(1, "mill", 8.0, corner, 50.0), Shank(30.0, 8.0))):
        pass
    exact = cube.Volume - cube.cut(solid_of(4.0, corner, 30.0, tip, axis)).Volume
    assert before - stock.volume == pytest.approx(exact, rel=0.02)


def test_a_job_takes_what_the_sweep_of_its_tool_takes(document):
    job = tool_job(document)
    add_operation(job, PLUNGE, "Plunge")
    plan = simulate_job(job)
    made = material_of(plan, 0.5)
    before = made.replay.stock.volume
    assert before == pytest.approx(CUBE**3, rel=0.005)
    made.replay.go_to(plan.duration)
    axis = np.array([math.sin(TILT), 0, math.cos(TILT)])
    poses = [solid_of(4.0, 0.0, 30.0, tip, axis) for tip in np.linspace([20, 10, 35], [12, 10, 13], 12)]
    cube = Part.makeBox(CUBE, CUBE, CUBE)
    exact = cube.Volume - cube.cut(poses).Volume
    assert before - made.replay.stock.volume == pytest.approx(exact, rel=0.02)
    compared = made.compared()
    assert compared.gouged == pytest.approx(exact, rel=0.03)  # the stock is the part


def test_times_of_lines_and_feeds_are_those_of_the_program(document, tmp_path):
    """On a machine without limits of jerk: with them, the feed here is 0.2 % below the programmed one."""
    job, machine = tool_job(document), tmp_path / "jumping.toml"
    machine.write_text(text_without_jerk(), encoding="utf-8")
    job.PostProcessorArgs = job.PostProcessorArgs.replace("example_6tps", str(machine))
    add_operation(job, PLUNGE, "Plunge")
    plan = simulate_job(job)
    begins = plan.line_begins(0, 5)  # the first two commands are comments
    block = plan.block_at(begins + 1e-3)
    assert plan.trajectory.place(block).line == 5
    assert plan.block_before(begins + 1e-3) == begins
    middle = (begins + plan.next_block(begins + 1e-6)) / 2
    assert plan.feed_at(middle) == pytest.approx(10.0, rel=1e-3)
    assert plan.feed_at(0.0) < 1.0
    assert plan.line_begins(0, 99) == pytest.approx(plan.duration, abs=1e-3)


def test_an_open_stock_and_none_cannot_be_cut(document):
    job = tool_job(document)
    add_operation(job, PLUNGE, "Plunge")
    plan = simulate_job(job)
    whole = plan.setup.stock
    assert can_be_cut(whole) and step_of(whole, 8000) == 1.0
    for stock in (None, Mesh("open", whole.triangles[1:])):
        assert not can_be_cut(stock)
        with pytest.raises(ValueError, match="closed stock"):
            material_of(replace(plan, setup=replace(plan.setup, stock=stock)), 1.0)


def test_a_tool_of_unknown_size_takes_nothing():
    assert cutting_part(Tool(1, "unknown", 0.0, 0.0, 50.0), None) is None
