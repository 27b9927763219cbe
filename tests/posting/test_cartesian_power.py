# SPDX-License-Identifier: LGPL-2.1-or-later
"""The form in tip and axis for a Power PMAC: with and without segmentation, and its guard."""

import dataclasses
import re
import sys
from pathlib import Path

import numpy as np
import programs
import pytest

from pkm_post.certificate.struts import AdjacentMotion, strut_jerk
from pkm_post.cli import main
from pkm_post.control.loading import program_to_load
from pkm_post.control.simulator import PowerPmac
from pkm_post.control.simulator.gpascii_shell import refused_line
from pkm_post.geometry import hermite_accelerations
from pkm_post.machine import find_machine, forward_along_path, machine_named
from pkm_post.model import Event, EventKind, Refused, StrutMotion
from pkm_post.options import Options
from pkm_post.posting import Allowance, cartesian_program, post
from pkm_post.posting.cartesian_axes import at_times, axis_motion, strut_motion
from pkm_post.posting.cartesian_check import _check_points, certify_axes, planned_of_one_tool
from pkm_post.posting.cartesian_guard import Setting, guard_lines, unguarded
from pkm_post.posting.cartesian_segments import on_segments, played_in_segments, program_points
from pkm_post.posting.verify import read_motion, verify
from pkm_post.toolpath import ToolPose
from pkm_post.writing import power_pmac

sys.path.append(str(Path(__file__).parents[1] / "writing" / "kinematics"))

import exported_machines as made  # noqa: E402

ROUNDING = 5e-7 * (np.sqrt(3) + np.sqrt(3) * np.radians(283.0))
"""mm: half a digit of X Y Z, and of A B C in degrees at the platform joints, 283 mm from the tip."""
SEGMENT, TOLERANCE = 2, 0.005
JOB = dataclasses.replace(programs.cone(30, turns=0.4), events=(Event(12, EventKind.STOP, 0.0),))
NUMBER = r"(-?[\d.]+)"
MOVE = re.compile(r"^" + " ".join(f"{letter}{NUMBER}:{NUMBER}" for letter in "XYZABC") + "$", re.M)
STEP = re.compile(r"^pvt(\d+)$|^X.*:.*$|^dwell0$", re.M)


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    """A machine with a Power PMAC, a folder with a job for it, and its forms without and with segments."""
    stated, folder = machine_named("example_6tps")[0], tmp_path_factory.mktemp("posted")
    machine = dataclasses.replace(stated, controller={**stated.controller, "kind": "power_pmac"})
    post(JOB, machine, folder / "job.pmc", Options(tip_tolerance=TOLERANCE, also=("cartesian",)))
    files = folder / "job.pmc", folder / "job.pkmt", machine
    return machine, folder, cartesian_program(*files, folder / "segments.pmc", segment_time=SEGMENT)


def counts_of(machine, axes, rates=None):
    """Lengths and speeds of the struts by the exported inverse program of the Power PMAC, mm and mm/s."""
    given = {"D0": 0.0 if rates is None else 1.0}
    given |= dict(zip(("C6", "C7", "C8", "C0", "C1", "C2"), axes.T, strict=True))
    if rates is not None:
        given |= dict(zip(("C38", "C39", "C40", "C32", "C33", "C34"), rates.T, strict=True))
    run = made.controller_of(machine, "power").run("inverse", given)
    scale, zero = machine.controller["counts_per_mm"], np.array(machine.controller["zero_length"])
    letters = "L" if rates is None else "LR"
    columns = [np.stack([run[f"{letter}{motor}"] for motor in range(1, 7)], axis=1) / scale for letter in letters]
    return columns[0] + zero, columns[-1]


def words_of(text):
    """Times since the last rest in ms, positions and rates of the points of each way between rests."""
    ways, interval, now = [], 0, 0
    for found in STEP.finditer(text):
        if found[0] == "dwell0":
            ways.append([])
            now = 0
        elif found[1]:
            interval = int(found[1])
        else:
            now += interval
            ways[-1].append((now, *map(float, MOVE.fullmatch(found[0]).groups())))
    return [np.array(way) for way in ways if way]


@pytest.mark.slow
def test_without_segments_the_exported_inverse_program_makes_the_struts_of_the_program(posted):
    """``--also cartesian`` of a posting: words of the text, through the kinematic program of ``machine export``."""
    machine, folder, _ = posted
    text = (folder / "job-tip.pmc").read_text()
    points = np.concatenate(words_of(text))[:, 1:]
    struts = read_motion(folder / "job.pmc", machine)
    found, speeds = counts_of(machine, points[:, 0::2], points[:, 1::2])
    np.testing.assert_allclose(found, struts.length[1:], rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(speeds, struts.speed[1:], rtol=0, atol=100 * ROUNDING)
    assert "// runs with kinematics, Coord[1].SegMoveTime=0, Q50=120 and Q51 to Q54 zero" in text
    assert "// kinematics in numbers of 53 bits, forward program of at most 9 steps to 1e-09 mm" in text


def basis(points, share):
    """A uniform cubic B-spline by its basis functions, from the first of four control points to the last four."""
    u = np.asarray(share)[None, :, None]
    p = [points[k : len(points) - 3 + k, None] for k in range(4)]
    weights = (1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3
    return sum(weight * point for weight, point in zip(weights, p, strict=True)) / 6


@pytest.mark.slow
def test_with_segments_the_struts_are_b_splines_through_the_exported_inverse_program(posted):
    """The text, cubics of its axes at the ends of segments, the exported program there, and basis functions."""
    machine, folder, form = posted
    text = form.files[0].read_text()
    ways = words_of(text)
    start = np.array(re.search(r"^X(\S+) Y(\S+) Z(\S+) A(\S+) B(\S+) C(\S+)$", text, re.M).groups(), dtype=float)
    assert len(ways) == 2 and all((way[:, 0] % SEGMENT == 0).all() for way in ways)
    share, before = np.array([0.0, 0.3, 0.7]), start
    axes = read_back(machine, form)
    played, row = played_in_segments(machine, axes, 120.0, SEGMENT), 0
    for way in ways:
        times = np.concatenate([[0.0], way[:, 0]])
        positions, rates = np.vstack([before, way[:, 1::2]]), np.vstack([np.zeros(6), way[:, 2::2]])
        grid = np.arange(0, times[-1] + 1, SEGMENT)
        points = counts_of(machine, hermite(times / 1000, positions, rates, grid / 1000))[0]
        control = np.vstack([points[:1], points[:1], points, points[-1:], points[-1:]])
        expected = basis(control, share).reshape(-1, 6)
        at = (played.time_ms[row] + SEGMENT * (np.arange(len(control) - 3)[:, None] + share)).ravel()
        np.testing.assert_allclose(at_times(played, at)[0], expected, rtol=0, atol=1e-9)
        row += len(control) - 3
        before = way[-1, 1::2]
    assert row == len(played) - 1 and played.events[0].row == round(np.flatnonzero(~played.speed.any(axis=1))[1])
    assert form.certificate.holds and 0.0 < form.off < ROUNDING


def read_back(machine, form):
    """The axes of a form at its knots, as the certificate reads them."""
    settings = dataclasses.replace(power_pmac.settings_of(machine)[0], letters=tuple("XYZABC"))
    guard = guard_lines(settings, Setting(120.0, Allowance(), SEGMENT))
    text = unguarded(form.files[0].read_text(), power_pmac.buffer_opening(settings), guard)
    return power_pmac.read_parts([("segments.pmc", text)], settings)[0]


def hermite(times, positions, rates, at):
    """Cubics with these positions and rates at their ends, by the Hermite basis."""
    row = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 2)
    span = (times[row + 1] - times[row])[:, None]
    s = (at - times[row])[:, None] / span
    values = (2 * s**3 - 3 * s**2 + 1) * positions[row] + (3 * s**2 - 2 * s**3) * positions[row + 1]
    return values + span * ((s**3 - 2 * s**2 + s) * rates[row] + (s**3 - s**2) * rates[row + 1])


def test_segments_cut_a_circle_by_the_law(posted):
    """v^2 T^2 / (6 r) inside the circle, for the tip and in parts by the struts' own curvature."""
    machine, radius, speed, segment = posted[0], 40.0, 50.0, 20
    time_ms = np.arange(0, 4001, segment, dtype=np.int64)
    angle = speed / radius * time_ms / 1000
    place, rate = np.zeros((len(angle), 6)), np.zeros((len(angle), 6))
    place[:, :3] = machine.home_tip
    place[:, 0] += radius * np.cos(angle)
    place[:, 1] += radius * np.sin(angle)
    rate[:, 0], rate[:, 1] = -speed * np.sin(angle), speed * np.cos(angle)
    axes = StrutMotion(time_ms, place, rate, ())
    played = played_in_segments(machine, axes, 120.0, segment)
    middle = np.arange(40, 160)
    reach = np.full(len(played), 120.0)
    tip = forward_along_path(machine, played.length, reach, ToolPose(place[0, :3], np.eye(3)[2], 0.0)).tip[middle]
    inside = radius - np.hypot(*(tip - machine.home_tip)[:, :2].T)
    assert inside.mean() == pytest.approx(speed**2 * (segment / 1000) ** 2 / (6 * radius), rel=0.02)


def test_points_go_to_whole_segments_and_stay_on_the_way(posted):
    machine, folder, _ = posted
    struts = read_motion(folder / "job.pmc", machine)
    moved = on_segments(struts, 7)
    rests = [0, moved.events[0].row, len(moved) - 1]
    assert (np.diff(moved.time_ms[rests]) % 7 == 0).all() and not moved.speed[rests].any()
    assert on_segments(struts, 1) is struts and on_segments(struts, 0) is struts
    source = struts.time_ms[[0, struts.events[0].row, len(struts) - 1]]
    assert (moved.time_ms[rests] >= source).all() and moved.time_ms[-1] - source[-1] < 2 * 7
    there = np.interp(moved.time_ms, moved.time_ms[rests], source)
    np.testing.assert_allclose(at_times(struts, there)[0], moved.length, rtol=0, atol=1e-9)


def test_segments_that_are_too_long_are_refused_with_what_they_do(posted, tmp_path):
    machine, folder, _ = posted
    files = folder / "job.pmc", folder / "job.pkmt", machine
    with pytest.raises(Refused) as refused:
        cartesian_program(*files, tmp_path / "tip.pmc", segment_time=40)
    codes = [fault.code for fault in refused.value.diagnostics]
    assert codes[0] == "C116" and len(codes) > 1 and "segments of 40 ms" in str(refused.value)
    assert "V119" not in codes and "shortest_interval" not in str(refused.value)  # segments are not its points
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_segments_are_refused_where_a_program_stops_without_a_code_or_a_dwell(posted, tmp_path):
    """By the definition of a uniform B-spline: it rests only where three control points are one."""
    machine, _, _ = posted
    ends, files = [[0, 0, 60], [10, 0, 60], [10, 0, 58], [10, 0, 60]], (tmp_path / "job.pmc", tmp_path / "job.pkmt")
    job, options = programs.program(ends, feed=10.0), Options(tip_tolerance=TOLERANCE, work_offset=programs.ON_PALLET)
    post(job, machine, files[0], options)
    with pytest.raises(Refused, match="line 3: error C116(?s:.*)a dwell where the tool stops"):
        cartesian_program(*files, machine, tmp_path / "tip.pmc", segment_time=1)
    post(dataclasses.replace(job, events=(Event(3, EventKind.DWELL, 0.0),)), machine, files[0], options)
    assert cartesian_program(*files, machine, tmp_path / "tip.pmc", segment_time=1).certificate.holds


SWITCHES = "Q50=120 Q51=0 Q52=0 Q53=0 Q54=0"


def on_the_simulator(text, switches, letters="UVW"):
    """Whether the program begins to move, with these values at the machine, and Q66."""
    machine = PowerPmac()
    lines = [*(f"#{motor}->100{letter}" for motor, letter in enumerate(letters, 1)), *SWITCHES.split()]
    lines += [f"#{motor}j/ #{motor}hmz" for motor in range(1, 7)] + switches.split()
    assert refused_line(machine, lines) is None
    machine.controller.variables.write("I", 5113, SEGMENT)  # there is no segmentation in the simulator
    assert refused_line(machine, text.splitlines()) is None
    assert refused_line(machine, ["&1b10r"]) is None
    machine.controller.advance(100)
    return machine.controller.systems[0].running, machine.controller.variables.read("Q", 66)


@pytest.mark.parametrize(
    ("switches", "letters", "reason"),
    [
        ("", "UVW", 0),
        ("", "UVWA", 1),
        ("", "XYZABC", 1),
        ("Q50=120.001", "UVW", 3),
        ("Q53=0.001", "UVW", 4),
        ("Q54=-0.001", "UVW", 5),
    ],
)
def test_it_ends_before_its_first_move_where_the_controller_is_set_up_otherwise(posted, switches, letters, reason):
    text = posted[2].files[0].read_text()
    assert on_the_simulator(text, switches, letters) == (reason == 0, reason)


def test_another_segment_time_ends_it(posted):
    assert on_the_simulator((posted[1] / "job-tip.pmc").read_text(), "") == (False, 2)


@pytest.mark.slow
def test_command_takes_the_segment_time(posted, tmp_path, capsys):
    machine, folder, form = posted
    file = tmp_path / "power.toml"
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    file.write_text(text.replace('kind = "turbo_pmac"', 'kind = "power_pmac"'), encoding="utf-8")
    post(JOB, machine_named(str(file))[0], tmp_path / "job.pmc", Options(tip_tolerance=TOLERANCE))
    out = tmp_path / "tip.pmc"
    given = [str(tmp_path / "job.pmc"), "--against", str(tmp_path / "job.pkmt"), "--out", str(out)]
    assert main(["cartesian", *given, "--machine", str(file), "--segment-time", str(SEGMENT)]) == 0
    assert "segments of 2 ms" in capsys.readouterr().out and "SegMoveTime!=2" in out.read_text()
    moves = [MOVE.findall(program.read_text()) for program in (out, form.files[0])]
    assert moves[0] == moves[1]


def test_a_turbo_pmac_has_no_segments_in_pvt_mode(posted, tmp_path):
    machine, folder, _ = posted
    turbo = dataclasses.replace(machine, controller={**machine.controller, "kind": "turbo_pmac"})
    with pytest.raises(Refused, match=r"M104.*segment time|segment time.*M104"):
        cartesian_program(folder / "job.pmc", folder / "job.pkmt", turbo, tmp_path / "tip.pmc", segment_time=2)


def test_it_is_verified_and_loaded_by_its_text_and_what_was_changed_is_refused(posted, tmp_path):
    """By its guard and its heading alone, without a manifest: the trajectory file is found in its folder."""
    machine, folder, form = posted
    certificate, report, _ = verify(form.files[0], folder / "job.pkmt", machine)
    assert certificate.findings == form.certificate.findings and report["files"]["programs_sha256"]
    settings = power_pmac.settings_of(machine)[0]
    (program, is_of_struts), faults = program_to_load(form.files[0], machine, settings)
    assert not faults and not is_of_struts and program.lines[0] == "Q66=0"
    changed, text = tmp_path / "changed.pmc", form.files[0].read_text()
    (tmp_path / "job.pkmt").write_bytes((folder / "job.pkmt").read_bytes())
    for before, after in (("SegMoveTime!=2", "SegMoveTime!=9"), ("Q50<119.9995", "Q50<19.9995"), ("Q66=1", "Q66=0")):
        changed.write_text(text.replace(before, after, 1))
        found, faults = program_to_load(changed, machine, settings, uncertified=True)
        assert found is None and "C109" in [fault.code for fault in faults]


def test_segments_are_no_points_of_the_program_for_the_limits_of_the_controller(posted, tmp_path):
    """1 ms are 1000 segments in a second, of 500 points that the controller of the example accepts; these are few."""
    machine, folder, _ = posted
    files = folder / "job.pmc", folder / "job.pkmt"
    assert cartesian_program(*files, machine, tmp_path / "tip.pmc", segment_time=1).certificate.holds
    axes = read_motion(files[0], machine)
    _check_points(axes, "tip.pmc", machine)
    with pytest.raises(Refused, match="V117"):
        _check_points(axes, "tip.pmc", dataclasses.replace(machine, block_rate=1.0))


JERKS = ("V112", "V115")


@pytest.mark.slow
@pytest.mark.parametrize("job", ["with a stop", *range(1, 5)])
def test_segments_of_a_millisecond_have_the_jerk_of_the_program_whatever_they_do_to_its_steps(job, posted, tmp_path):
    """As shipped, and not with limits that it exceeds: the spline over segments of 1 ms is what the cubics are."""
    machine, _, _ = posted
    made = JOB if job == "with a stop" else programs.random_job(np.random.default_rng(SEEDS[job - 1]))
    files = tmp_path / "job.pmc", tmp_path / "job.pkmt"
    post(made, machine, files[0], Options(tip_tolerance=0.02, axis_tolerance=0.05, work_offset=programs.ON_PALLET))
    direct = verify(*files, machine)[0]
    played = cartesian_program(*files, machine, tmp_path / "tip.pmc", segment_time=1).certificate
    for code in JERKS:
        assert figure_of(played, code) == pytest.approx(figure_of(direct, code), rel=2e-3)
    ramp = next(each.value for each in played.figures if each.name.startswith("step"))
    assert 0.9 < ramp / largest_change(read_motion(files[0], machine)) < 1.01  # the spline is smoother than the cubics
    axes = axis_motion(machine, read_motion(files[0], machine), 120.0, planned_of_one_tool(files[1], "job.pmc"))
    tight = dataclasses.replace(machine, strut_jerk=0.99 * figure_of(direct, "V112"))
    with pytest.raises(Refused, match=r"C116(?s:.*)V112"):
        certify_axes(axes, "tip.pmc", files[1], tight, Setting(120.0, Allowance(), 1), [])


def largest_change(struts):
    """Largest change of a strut's acceleration in two milliseconds: where cubics meet, it is the mean of both.

    A stop takes its time, so nothing changes from before it to after it.
    """
    begin, end = hermite_accelerations(*struts.cubics(np.arange(len(struts) - 1)))
    time = np.arange(struts.time_ms[-1] + 1)

    def of(side):
        row = np.clip(np.searchsorted(struts.time_ms, time, side) - 1, 0, len(begin) - 1)
        share = (time - struts.time_ms[row]) / np.diff(struts.time_ms)[row]
        return begin[row] + share[:, None] * (end - begin)[row]

    mean = (of("left") + of("right")) / 2
    stops = struts.time_ms[[event.row for event in struts.events if event.kind is EventKind.STOP]]
    at_stop = (np.abs(time[1:-1, None] - stops) <= 1).any(axis=1)
    return np.abs(mean[2:] - mean[:-2])[~at_stop].max()


SEEDS = (2, 4, 11, 12)
"""Jobs of which the spline over segments of 1 ms had over 1.2 of a limit of jerk, or up to 0.97 of it."""


def figure_of(certificate, code):
    return next(found.value for found in certificate.findings if found.code == code)


@pytest.mark.parametrize("segment", [1, 2, 3, 5, 8])
@pytest.mark.parametrize("seed", range(4))
def test_jerk_of_a_motion_is_found_whatever_the_segments(segment, seed, posted):
    """Sums of sines, with points by chance: what finite differences of the exact struts find, at every 0.5 ms."""
    machine, chance = posted[0], np.random.default_rng(seed)
    wide = np.array([20.0, 20.0, 10.0, 1.5, 1.5, 1.5]) * chance.uniform(0.3, 1, (3, 6))
    omega, phase = 2 * np.pi * chance.uniform(0.4, 2.0, (3, 6)), chance.uniform(0, 2 * np.pi, (3, 6))
    moves = np.append(0, np.cumsum(segment * chance.integers(1, 24 // segment + 1, 400)))
    moves = moves[moves <= 2400]
    whole, rate = sines(moves / 1000, wide, omega, phase)
    whole[:, :3] += machine.home_tip
    axes = StrutMotion(moves, whole, rate, ())
    points = program_points(machine, axes, 120.0, segment)
    inner = (points.before > 0) & (points.after < len(moves) - 1)  # it does not begin and end at rest
    found = strut_jerk(played_in_segments(machine, axes, 120.0, segment), AdjacentMotion(), points)[points.knots]
    fine = np.arange(0, moves[-1] + 0.5, 0.5)
    dense, there = sines(fine / 1000, wide, omega, phase)
    dense[:, :3] += machine.home_tip
    length = strut_motion(machine, StrutMotion(fine, dense, there, ()), 120.0).length
    true = np.abs(np.diff(length, n=3, axis=0) / 0.0005**3).max()
    assert 0.9 * true <= found[inner].max() <= 1.001 * true


def sines(seconds, wide, omega, phase):
    """Places and rates of axes that swing, (T, 6) each."""
    turn = omega * seconds[:, None, None] + phase
    return (wide * np.sin(turn)).sum(axis=1), (wide * omega * np.cos(turn)).sum(axis=1)


def test_points_within_a_segment_are_refused(posted):
    machine, folder, _ = posted
    axes = read_motion(folder / "job.pmc", machine)
    within = next(time for time in axes.time_ms if time % 9)
    with pytest.raises(Refused, match=f"C101.*point at {within} ms, expected whole segments of 9 ms"):
        _check_points(axes, "tip.pmc", machine, 9)
