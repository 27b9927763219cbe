# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces, bores and bosses are found by a touch probe, and what is not as it should be is refused."""

import copy
import dataclasses
import math
import re

import numpy as np
import pytest
from rig import served
from station import MACHINE, SETTINGS, TOOL, set_up

from pkm_post.cli import main
from pkm_post.control.link.errors import DiagnosedError, NotReadyError
from pkm_post.control.link.tool_pose import ToolPoseReadout
from pkm_post.control.numerical_control import watchdog
from pkm_post.control.numerical_control.probed_features import measure_bore, measure_boss, measure_face, origin_for
from pkm_post.control.numerical_control.probing import Contact, Probe, ProbeInput, ProbeSettings
from pkm_post.control.numerical_control.simulated_probe import SimulatedProbe, body_of, bore, boss, plane
from pkm_post.control.numerical_control.watchdog import silence_s

BALL, INPUT = 6.0, 1000
HOME = np.array([0.0, 0.0, 300.0])
COUNT = 1e-4
"""mm of a strut: twice what a place may be off by the rounding of programs."""


def simulated(station, body):
    SimulatedProbe(station.wire.controller, SETTINGS, ToolPoseReadout(MACHINE, TOOL), BALL, body).connect(INPUT)


def probe_at(station, body, resolution=0.001, **settings):
    """A probe on a machine at its home, above or in a body."""
    simulated(station, body)
    session = station.control._session
    made = ProbeSettings(ProbeInput(f"M{INPUT}"), BALL, resolution=resolution, **settings)
    return Probe(session, station.control, made, silence_s(session, SETTINGS))


def frame(degrees=0.0, origin=(0.0, 0.0, 0.0)):
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    made = np.eye(4)
    made[:2, :2] = [[cos, -sin], [sin, cos]]
    made[:3, 3] = origin
    return made


@pytest.mark.slow
def test_a_face_is_found_within_its_half_width(station):
    height = 295.8345
    found = measure_face(probe_at(station, plane(height)), frame(), "z-", 10.0)
    assert found.half_width <= 0.0005 and np.isnan(found.position[:2]).all()
    assert abs(found.position[2] - height) <= found.half_width + COUNT
    assert np.abs(station.control.standing_pose().tip - HOME).max() < COUNT


class ExactProbe:
    """A probe that knows each contact to the last digit, and moves in no time; it never ends in a body."""

    settings = ProbeSettings(ProbeInput("M1"), BALL)

    def __init__(self, body):
        self.tip, self._gap = HOME.copy(), lambda tip: body(tip) - BALL / 2
        self.lowest = HOME[2]

    def go(self, target):
        way = np.linspace(self.tip, target, 200)
        assert min(map(self._gap, way)) >= 0, "the way is not free"
        self.tip, self.lowest = way[-1], min(self.lowest, target[2])

    def touch(self, direction, within):
        near, far = 0.0, within
        assert self._gap(self.tip) > 0 >= self._gap(self.tip + within * direction), "nothing is met"
        while far - near > 1e-12:
            middle = (near + far) / 2
            near, far = (middle, far) if self._gap(self.tip + middle * direction) > 0 else (near, middle)
        return Contact(self.tip + near * direction, 0.0)


def test_the_work_offset_follows_from_a_face():
    work, probe = frame(30.0, (1.0, 2.0, 290.0)), ExactProbe(plane(291.5))
    found = measure_face(probe, work, "z-", 10.0)
    assert found.position[2] == pytest.approx(1.5) and np.isnan(found.position[:2]).all()
    assert origin_for(found, work, np.array([7.0, 7.0, 0.5])) == pytest.approx([1.0, 2.0, 291.0])


@pytest.mark.parametrize(("along", "sign"), [("x-", 1), ("x+", -1), ("y-", 1), ("y+", -1)])
def test_a_face_is_half_a_ball_beyond_the_contact(along, sign):
    work, axis = frame(30.0, (1.0, 2.0, 0.0)), "xyz".index(along[0])
    probe = ExactProbe(lambda tip: sign * ((work[:3, :3].T @ (tip - work[:3, 3]))[axis] + sign * 8.0))
    assert measure_face(probe, work, along, 20.0).position[axis] == pytest.approx(-sign * 8.0)


@pytest.mark.parametrize("degrees", [0.0, 25.0, 90.0, -140.0])
def test_a_bore_is_found_from_beside_its_centre(degrees):
    centre, diameter, work = np.array([1.3, -0.8, 310.0]), 30.25, frame(degrees, (5.0, -3.0, 0.0))
    probe = ExactProbe(bore(tuple(centre), diameter))
    found = measure_bore(probe, work, 20.0)
    assert found.position[:2] == pytest.approx((work[:3, :3].T @ (centre - work[:3, 3]))[:2])
    assert math.isnan(found.position[2])
    assert found.diameters == pytest.approx([diameter] * 2)
    assert origin_for(found, work, np.array([2.0, 0.0, 9.0])) == pytest.approx([*(centre[:2] - work[:2, 0] * 2.0), 0.0])
    assert probe.tip == pytest.approx([*centre[:2], HOME[2]])


@pytest.mark.parametrize("degrees", [0.0, 33.0])
def test_a_boss_is_found_by_free_ways_and_the_probe_ends_above_its_centre(degrees):
    centre, diameter = np.array([-0.9, 0.6, 295.0]), 24.0
    probe = ExactProbe(boss(tuple(centre), diameter))
    found = measure_boss(probe, frame(degrees), 23.5, 10.0, 3.0)
    assert frame(degrees)[:2, :2] @ found.position[:2] == pytest.approx(centre[:2])
    assert found.diameters == pytest.approx([diameter] * 2) and probe.lowest == HOME[2] - 10.0
    assert probe.tip == pytest.approx([*centre[:2], HOME[2]])


@pytest.mark.slow
def test_it_is_pushed_no_further_than_it_allows(station, monkeypatch):
    height, tips = 296.0, []
    probe = probe_at(station, plane(height), 0.05, overtravel=0.8)
    poll = station.control.poll
    monkeypatch.setattr(station.control, "poll", lambda: tips.append(poll()) or tips[-1])
    measure_face(probe, frame(), "z-", 10.0)
    deepest = height - (min(each.pose.tip[2] for each in tips) - BALL / 2)
    assert 0.0 < deepest < 0.8


@pytest.mark.parametrize(
    ("body", "code", "within"),
    [(plane(298.0), "C220", 10.0), (plane(200.0), "C221", 2.0)],
)
def test_a_probe_that_is_touched_or_meets_nothing_is_refused(station, body, code, within):
    probe = probe_at(station, body)
    with pytest.raises(DiagnosedError) as refused:
        measure_face(probe, frame(), "z-", within)
    assert refused.value.diagnostic.code == code and not station.wire.controller.runs_program()


def test_a_contact_on_the_way_stops_the_probe_there(station):
    probe = probe_at(station, plane(296.0))
    with pytest.raises(DiagnosedError) as refused:
        probe.go(HOME - [0.0, 0.0, 5.0])
    state = station.to_rest()
    assert refused.value.diagnostic.code == "C223" and not station.wire.controller.runs_program()
    assert 299.0 - probe.settings.overtravel < state.pose.tip[2] < 299.0


@pytest.mark.slow
def test_an_input_that_hangs_is_refused_where_the_probe_began(station):
    seen = []
    probe = probe_at(station, plane(0.0))
    station.wire.controller.inputs[INPUT] = lambda: float(seen.append(1) is None and len(seen) > 20)
    with pytest.raises(DiagnosedError) as refused:
        measure_face(probe, frame(), "z-", 10.0)
    assert refused.value.diagnostic.code == "C222"
    assert np.abs(station.control.standing_pose().tip - HOME).max() < COUNT


def test_an_input_that_is_neither_0_nor_1_is_refused(station):
    probe = probe_at(station, plane(0.0))
    station.wire.controller.inputs[INPUT] = lambda: 17.0
    with pytest.raises(NotReadyError, match="M1000: expected 0 or 1 from the input of the probe, got 17"):
        probe.touch(np.array([0.0, 0.0, -1.0]), 10.0)


def test_an_operator_who_aborts_ends_the_probing(station, monkeypatch):
    probe, polls = probe_at(station, plane(0.0)), []
    poll = station.control.poll

    def polled():
        polls.append(1)
        if len(polls) == 30:
            station.control.abort()
        return poll()

    monkeypatch.setattr(station.control, "poll", polled)
    with pytest.raises(NotReadyError, match="mm from where it leads to: it was stopped"):
        probe.touch(np.array([0.0, 0.0, -1.0]), 10.0)
    assert not station.wire.controller.runs_program()


def test_an_input_survives_a_reset_and_belongs_to_no_saved_state(station):
    controller = station.wire.controller
    simulated(station, plane(298.0))
    controller.save()
    assert controller.variables.read("M", INPUT) == 1.0
    controller.inputs.clear()
    controller.inputs[INPUT] = lambda: 0.0
    controller.reset()
    assert controller.variables.read("M", INPUT) == 0.0


@pytest.mark.parametrize(
    ("text", "expected"),
    [("M1000", ("M1000", 1)), ("p12=0", ("P12", 0)), ("M7=1", ("M7", 1)), ("I5", None), ("M1=2", None), ("M1 ", None)],
)
def test_inputs_by_name(text, expected):
    if expected is None:
        with pytest.raises(ValueError, match="expected an M- or P-variable"):
            ProbeInput.from_text(text)
    else:
        assert dataclasses.astuple(ProbeInput.from_text(text)) == expected


@pytest.mark.slow
def test_a_face_is_measured_over_tcp(capsys, monkeypatch):
    monkeypatch.setattr(watchdog, "CREDIT_MS", 60_000)  # this computer may be late, in the fast time of the machine
    made = copy.deepcopy(set_up())
    SimulatedProbe(made, SETTINGS, ToolPoseReadout(MACHINE, TOOL), BALL, body_of("plane:296.2")).connect(INPUT)
    words = [
        "--machine",
        "example_6tps",
        "--patience",
        "10",
        "--input",
        f"M{INPUT}",
        "--ball",
        str(BALL),
        "--overtravel",
        "60",
    ]
    with served(made, speed=5.0) as port:
        measure = ["pmac", "measure", "face", "--port", port, *words, "--along", "z-", "--resolution", "0.2"]
        assert main([*measure, "--at", "6", "--work-offset", "G54"]) == 0
        said = capsys.readouterr().out
        assert main([*measure, "--within", "0.2"]) == 1
        assert "C221" in capsys.readouterr().err
        for lacks in (["face"], ["bore", "--along", "z-"], ["boss", "--depth", "3"], ["bore", "--at", "1"]):
            assert main(["pmac", "measure", *lacks, "--port", port, *words]) == 2
            assert f"error U103: an argument is not valid: {lacks[0]}: expected " in capsys.readouterr().err
    origin = MACHINE.work_offsets["G54"][:3, 3]
    found = float(re.search("face: Z(\\S+) in G54, mm", said)[1])
    assert found == pytest.approx(296.2 - origin[2], abs=0.1) and "each contact within 0.0" in said
    stated = [float(word) for word in re.search("--work-offset=(\\S+)", said)[1].split(",")]
    assert stated == pytest.approx([*origin[:2], 290.2, 0.0], abs=0.1)


@pytest.mark.parametrize(
    ("text", "inside", "outside"),
    [
        ("plane:10", (5, 5, 9), (5, 5, 11)),
        ("bore:1,2,10,8", (5.1, 2, 9), (1, 2, 9)),
        ("boss:1,2,10,8", (1, 2, 9), (5.1, 2, 9)),
    ],
)
def test_bodies_by_name(text, inside, outside):
    assert body_of(text)(np.array(inside, float)) < 0 < body_of(text)(np.array(outside, float))


@pytest.mark.parametrize("text", ["plane", "plane:1,2", "bore:1,2,3", "boss:1,2,3,-4", "cone:1", "plane:nan"])
def test_bodies_that_are_none(text):
    with pytest.raises(ValueError, match="expected plane:Z, bore:X,Y,Z,DIAMETER or boss:X,Y,Z,DIAMETER"):
        body_of(text)
