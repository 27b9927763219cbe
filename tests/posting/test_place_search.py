# SPDX-License-Identifier: LGPL-2.1-or-later
"""A place for a program out of reach: its amounts, and that posting holds there."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from programs import ON_PALLET, cone

from pkm_post.cli import main
from pkm_post.machine import SpinRule, best_position, good_positions, machine_named
from pkm_post.model import Diagnostic, Place, errors
from pkm_post.model.machine import Box
from pkm_post.options import Options
from pkm_post.posting import (
    PLACE_STEP,
    find_place,
    may_be_mended,
    place_offer,
    place_options,
    place_search,
    study,
    trajectory_of,
    work_offset_text,
)
from pkm_post.posting.place_search import MENDED_BY_A_PLACE

LONG = """\
T1 M6 G43 H1
G21 G90 G94 S8000 M3
G0 X0 Y0 Z30
G1 X10 Y0 Z20 F600
G1 X20 Y5 Z20
M30
"""


@pytest.fixture(scope="module")
def machine():
    return machine_named("example_6tps")[0]


def shifted(x, degrees=0.0):
    turn, offset = np.radians(degrees), ON_PALLET.copy()
    offset[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    offset[0, 3] += x
    return offset


@cache
def far():
    """Options of a cone that lies too far in x, and the place that is found for it, with diagnostics."""
    options = Options(work_offset=shifted(500.0))
    return options, *find_place(cone(60), machine_named("example_6tps")[0], options)


@pytest.mark.slow
def test_a_place_is_found_with_its_amounts(machine):
    program, before = cone(60), shifted(500.0)
    options, found, diagnostics = far()
    assert "K102" in {each.code for each in errors(study(program, machine, options)[1])}
    assert found is not None and found.holds and not diagnostics and not found.spins
    # the amounts are those between the offsets: of the middle of the tips, independently of the search
    tips = program.position @ before[:3, :3].T + before[:3, 3]
    change = found.options.work_offset @ np.linalg.inv(before)
    middle = (tips.min(axis=0) + tips.max(axis=0)) / 2
    assert change[:3, :3] @ middle + change[:3, 3] - middle == pytest.approx(found.shift, abs=1.0)
    assert np.degrees(np.arctan2(change[1, 0], change[0, 0])) == pytest.approx(found.turn[2], abs=1e-3)
    assert found.shift[0] < -100.0
    assert f"shift {found.shift[0]:.1f} mm in x" in found.text() and ": reaches, " in found.text()
    strokes = [each.margin.min() for each in found.reach.findings if each.subject.name.endswith("struts")]
    spare = float(found.text().split("reaches, ")[1].split(" mm to spare")[0])
    assert 0.0 < spare <= min(strokes) + 0.05


@pytest.mark.slow
def test_the_place_holds_as_its_offset_is_typed(machine):
    found, _ = find_place(cone(60), machine, Options(work_offset=shifted(500.0, 20.0)))
    typed = [float(word) for word in work_offset_text(found.options.work_offset).partition("=")[2].split(",")]
    turn, offset = np.radians(typed[3]), np.eye(4)
    offset[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    offset[:3, 3] = typed[:3]
    assert offset == pytest.approx(found.options.work_offset, abs=1e-9)
    assert not errors(study(cone(60), machine, Options(work_offset=offset))[1])


def test_a_freedom_that_is_not_given_is_kept(machine):
    found, _ = find_place(cone(60), machine, Options(work_offset=shifted(300.0)), "x")
    assert found.shift[1:] == pytest.approx([0.0, 0.0]) and found.turn == pytest.approx([0.0] * 3)


@pytest.mark.slow
def test_a_program_too_large_for_the_machine_is_said_not_to_fit(machine):
    program = cone(12)
    huge = type(program)(**{**vars(program), "position": program.position * np.array([30.0, 30.0, 1.0])})
    found, _ = find_place(huge, machine, Options(work_offset=ON_PALLET), "x")
    assert found is not None and not found.holds
    assert "does not suffice: K" in found.text() and "missing" in found.text()
    assert found.options.spin.rule is SpinRule.OPTIMISED and found.spins


@pytest.mark.slow
def test_the_command_says_the_amounts_and_the_option(tmp_path, capsys):
    part = tmp_path / "part.ngc"
    part.write_text(LONG)
    arguments = ["reach", str(part), "--tool-length", "1=80", "--work-offset=600,0,200"]
    assert main(arguments) == 1
    offer = f"`reach {part} --place` looks for one"
    assert offer in capsys.readouterr().err
    assert main(["post", *arguments[1:], "--out", str(tmp_path / "out")]) == 1
    assert offer in capsys.readouterr().err and list((tmp_path / "out").iterdir()) == []
    assert main([*arguments, "--place"]) == 0
    shown = capsys.readouterr().out
    assert "place: shift -" in shown and ": reaches, " in shown
    offset = next(line for line in shown.splitlines() if line.startswith("work offset: ")).split()[-1]
    assert main([*arguments[:-1], offset]) == 0


@pytest.mark.slow
def test_a_refused_post_says_the_place_and_the_options_that_post_it(tmp_path, capsys):
    part = tmp_path / "part.ngc"
    part.write_text(LONG)
    out = tmp_path / "out"
    arguments = ["post", str(part), "--tool-length", "1=80", "--work-offset=600,0,200", "--out", str(out)]
    assert main([*arguments, "--find-place"]) == 1
    said = capsys.readouterr().err
    assert "K102" in said and "reach part" not in said and not list(out.iterdir())
    (line,) = [line for line in said.splitlines() if ": place: " in line]
    assert f"{part}: place: shift -" in line and ": reaches, " in line and " mm to spare" in line
    options = line.partition("; with the same options and ")[2].split()
    assert main([*arguments, *options]) == 0
    assert out / "part.pmc" in out.iterdir()


@pytest.mark.slow
def test_a_post_without_a_place_says_what_was_tried_last(tmp_path, capsys, monkeypatch):
    """Points two metres apart: no shift and no turn brings both into reach; few places are tried, to save time."""
    for name in ("_MORE_STARTS", "_MOST_JUDGED"):
        monkeypatch.setattr(place_search, name, 1)
    part = tmp_path / "part.ngc"
    part.write_text(LONG.replace("X20 Y5", "X2000 Y5"))
    arguments = ["post", str(part), "--tool-length", "1=80", "--work-offset=0,0,200", "--out", str(tmp_path / "out")]
    assert main([*arguments, "--find-place"]) == 1
    said = capsys.readouterr().err
    assert "place: no place was found; the last that was tried: " in said and "does not suffice: K" in said


def test_other_faults_are_not_searched_for(tmp_path, capsys):
    part = tmp_path / "part.ngc"
    part.write_text(LONG)
    assert main(["post", str(part), "--work-offset=600,0,200", "--out", str(tmp_path), "--find-place"]) == 1
    said = capsys.readouterr().err
    assert "J113" in said and "place:" not in said


@pytest.mark.slow
def test_options_of_a_place_keep_other_fixtures_beside_the_first():
    _, found, _ = far()
    beside = np.eye(4)
    beside[:3, 3] = 100.0, 0.0, -5.0
    offset, origin = place_options(found, {"G54": np.eye(4), "G55": beside})
    assert offset == work_offset_text(found.options.work_offset)
    assert origin == "--origin=G55=100.000,0.000,-5.000,0.0000"
    tilted = beside[[0, 2, 1, 3]]
    assert place_options(found, {"G54": np.eye(4), "G55": tilted}) == []


@pytest.mark.slow
def test_where_the_best_place_collides_another_good_one_is_taken(machine):
    """A block stands beside the machine's home, where the platform would be at the place with the largest margins."""
    program, options = cone(60), Options(work_offset=shifted(300.0))
    best, _ = find_place(program, machine, options)
    offset = best.options.work_offset
    block = Box("block", np.array([165.0, -30.0, 250.0]), np.array([225.0, 30.0, 900.0]))
    crowded = replace(machine, fixtures=(*machine.fixtures, block))
    codes = {each.code for each in errors(study(program, crowded, best.options)[1])}
    assert codes and codes <= MENDED_BY_A_PLACE
    found, _ = find_place(program, crowded, options)
    assert found.holds and not errors(study(program, crowded, found.options)[1])
    assert not np.allclose(found.options.work_offset, offset)


@pytest.mark.slow
def test_good_positions_are_apart_and_leave_something(machine):
    placed, _ = trajectory_of(cone(60), machine, Options(work_offset=ON_PALLET))
    best = best_position(placed, machine)
    first, *others = good_positions(placed, machine)
    np.testing.assert_array_equal(first.move, best.move)
    assert len(others) > 4 and all(each.after.min() > 0.0 for each in others)
    moves = np.array([each.move for each in (first, *others)])
    apart = np.abs(moves[:, None] - moves).max(axis=2)[np.triu_indices(len(moves), 1)]
    assert apart.min() > 0.01
    assert np.ptp(moves[:5, :3], axis=0).max() > 50.0  # far apart, the first ones at that


def test_the_search_reports_and_can_be_stopped(machine):
    class EnoughError(Exception):
        pass

    reported = []

    def progress(step, share):
        reported.append((step, share))
        if len(reported) > 1:
            raise EnoughError

    with pytest.raises(EnoughError):
        find_place(cone(60), machine, Options(work_offset=shifted(300.0)), progress=progress)
    assert {step for step, _ in reported} == {PLACE_STEP}
    assert all(0.0 <= share < 1.0 for _, share in reported)


def test_a_refusal_that_no_place_mends_offers_none():
    faults = [Diagnostic("K102", Place("part"), ""), Diagnostic("J113", Place("part"), "")]
    assert place_offer(faults, "part") == place_offer((), "part") == ""
    assert "`reach part --place`" in place_offer(faults[:1], "part")


@pytest.mark.parametrize(
    ("codes", "may"), [("K102", True), ("K104 K121 K118", True), ("K102 J113", False), ("K118", False), ("", False)]
)
def test_what_a_place_may_mend(codes, may):
    assert may_be_mended([Diagnostic(code, Place("part"), "") for code in codes.split()]) == may
