# SPDX-License-Identifier: LGPL-2.1-or-later
"""A place for a program out of reach: its amounts, and that posting holds there."""

import numpy as np
import pytest
from programs import ON_PALLET, cone

from pkm_post.cli import main
from pkm_post.machine import SpinRule, machine_named
from pkm_post.model import errors
from pkm_post.options import Options
from pkm_post.posting import find_place, study, work_offset_text

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


def test_a_place_is_found_with_its_amounts(machine):
    program, before = cone(60), shifted(500.0)
    options = Options(work_offset=before)
    assert "K102" in {each.code for each in errors(study(program, machine, options)[1])}
    found, diagnostics = find_place(program, machine, options)
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


def test_a_program_too_large_for_the_machine_is_said_not_to_fit(machine):
    program = cone(12)
    huge = type(program)(**{**vars(program), "position": program.position * np.array([30.0, 30.0, 1.0])})
    found, _ = find_place(huge, machine, Options(work_offset=ON_PALLET), "x")
    assert found is not None and not found.holds
    assert "does not suffice: K" in found.text() and "missing" in found.text()
    assert found.options.spin.rule is SpinRule.OPTIMISED and found.spins


def test_the_command_says_the_amounts_and_the_option(tmp_path, capsys):
    part = tmp_path / "part.ngc"
    part.write_text(LONG)
    arguments = ["reach", str(part), "--tool-length", "1=80", "--work-offset=600,0,200"]
    assert main(arguments) == 1
    assert "reach --place" in capsys.readouterr().err  # the cure
    assert main([*arguments, "--place"]) == 0
    shown = capsys.readouterr().out
    assert "place: shift -" in shown and ": reaches, " in shown
    offset = next(line for line in shown.splitlines() if line.startswith("work offset: ")).split()[-1]
    assert main([*arguments[:-1], offset]) == 0
