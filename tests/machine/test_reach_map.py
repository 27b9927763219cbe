# SPDX-License-Identifier: LGPL-2.1-or-later
"""The reach map against single poses, and the same whoever does the work."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from machines import direction

from pkm_post.cli import main
from pkm_post.machine.description.presets import machine_named
from pkm_post.machine.reach.limit_checks import reach_margins
from pkm_post.machine.reach.reach_map import NOWHERE, reach_map

LENGTH = 120.0
STEP = np.radians(1.0)


@pytest.fixture(scope="module")
def machine():
    return machine_named("example_6tps")[0]


def grid():
    x, y, z = np.meshgrid([-150.0, 0.0, 150.0], [-150.0, 0.0, 150.0], [150.0, 300.0], indexing="ij")
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()])


def is_reached(machine, tip, tilt, azimuths=24):
    axis = direction(np.degrees(np.full(azimuths, tilt)), np.arange(azimuths) * 360 / azimuths).T
    upright = np.vstack([[0.0, 0.0, 1.0], axis])  # the sign of the determinant is compared with the first pose
    margins = reach_margins(machine, np.tile(tip, (len(upright), 1)), upright, np.zeros(25), np.full(25, LENGTH))
    every = (margins.shortest, margins.longest, margins.base, margins.platform, margins.singular[:, None])
    return all((margin >= 0).all() for margin in every)


def test_within_the_cone_all_is_reached_and_one_step_beyond_not(machine):
    found = reach_map(machine, grid(), LENGTH)
    assert (found.cone > 0).any()
    for tip, cone in zip(found.tip, found.cone, strict=True):
        if cone == NOWHERE:
            assert not is_reached(machine, tip, 0.0)
            continue
        assert is_reached(machine, tip, cone)
        assert cone == found.widest or not is_reached(machine, tip, cone + STEP)


@pytest.mark.parametrize("widest", [0.4, 10.4, 10.6])
def test_the_widest_angle_is_tried_and_none_beyond_it(machine, widest):
    found = reach_map(machine, np.array([[0.0, 0.0, 250.0]]), LENGTH, np.radians(widest))
    assert found.as_csv().splitlines()[1] == f"0,0,250,{widest:.2f},"
    assert is_reached(machine, found.tip[0], found.cone[0])


def test_a_place_outside_has_no_cone(machine):
    found = reach_map(machine, np.array([[2000.0, 0.0, 200.0]]), LENGTH)
    assert found.cone.tolist() == [NOWHERE]
    assert found.as_csv().splitlines()[1] == "2000,0,200,,stroke"


def test_symmetric_places_have_the_same_cone(machine):
    # The example machine is its own mirror image in the xz plane.
    found = reach_map(machine, np.array([[50.0, 80.0, 250.0], [50.0, -80.0, 250.0]]), LENGTH)
    assert found.cone[0] == found.cone[1]


@pytest.mark.slow
def test_an_executor_gives_the_same(machine):
    places = np.tile(grid(), (8, 1))
    with ThreadPoolExecutor(2) as executor:
        shared = reach_map(machine, places, LENGTH, executor=executor)
    alone = reach_map(machine, places, LENGTH)
    assert shared.cone.tolist() == alone.cone.tolist()
    assert shared.limit.tolist() == alone.limit.tolist()
    assert len(alone.as_csv().splitlines()) == len(places) + 1


def test_places_of_another_shape_are_a_fault_of_the_caller(machine):
    with pytest.raises(ValueError, match=r"expected \(N, 3\)"):
        reach_map(machine, np.zeros(3), LENGTH)


def test_the_command_writes_data_and_picture(tmp_path, capsys):
    small = ["--x=-50:50:50", "--y=0:50:50", "--z=200:250:50", "--widest=5"]
    assert main(["reach-map", "example_6tps", "--out", str(tmp_path), *small]) == 0
    assert len((tmp_path / "example_6tps-reach.csv").read_text().splitlines()) == 1 + 3 * 2 * 2
    assert (tmp_path / "example_6tps-reach.png").read_bytes().startswith(b"\x89PNG")
    assert capsys.readouterr().out.splitlines() == [
        str(tmp_path / f"example_6tps-reach.{end}") for end in ("csv", "png")
    ]


def test_the_command_tells_faults(tmp_path, capsys):
    assert main(["reach-map", "no_such_machine", "--out", str(tmp_path)]) == 1
    assert "M101" in capsys.readouterr().err


def test_a_map_of_more_places_than_fit_is_refused(capsys):
    assert main(["reach-map", "example_6tps", "--x=0:1000:1", "--y=0:1000:1"]) == 2
    assert "expected --x, --y and --z with at most 1000000 places together" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--x", "1:0:5"], "expected FROM:TO:STEP with 1 to 1000000 places, got '1:0:5'"),
        (["--length", "0"], "expected a number above 0 and up to 10000, got '0'"),
        (["--x", "0:1e300:1e-300"], "expected a number from -1000000 to 1000000, got '1e300'"),
        (["--x", "0:1e5:1e-3"], "expected FROM:TO:STEP with 1 to 1000000 places, got '0:1e5:1e-3'"),
        (["--widest", "nan"], "expected a number, got 'nan'"),
        (["--widest", "180"], "expected an angle above 0 and below 180, got '180'"),
    ],
)
def test_arguments_without_sense_are_reported(arguments, message, capsys):
    with pytest.raises(SystemExit):
        main(["reach-map", "example_6tps", *arguments])
    assert message in capsys.readouterr().err
