# SPDX-License-Identifier: LGPL-2.1-or-later
"""The uncertainty of a calibration: against the linear estimate, against calibrations that are really off, and laws."""

import dataclasses

import numpy as np
import pytest
from machines import direction

from pkm_post.cli import main
from pkm_post.machine import MeasuredPoses, MeasurementNoise, calibrate, calibration_uncertainty, machine_named
from pkm_post.machine.calibration.calibrate_file import COLUMNS
from pkm_post.machine.calibration.uncertainty import noise_of_residuals, parameters_of, tip_distances
from pkm_post.machine.kinematics.inverse import strut_lengths

LENGTH_NOISE = 0.002  # mm, of a linear scale
TRACKER = MeasurementNoise(tip=0.01, angle=2e-5, length=LENGTH_NOISE)


@pytest.fixture(scope="module")
def real():
    return machine_named("nategh_agheli_calibrated")[0]


def measured(machine, count=24, tilt_deg=20.0, noise=LENGTH_NOISE, seed=1):
    """Poses in the working volume, exact, and their lengths with noise."""
    random = np.random.default_rng(seed)
    tip = random.uniform([-150, -150, 750], [150, 150, 950], (count, 3))
    axis = direction(random.uniform(0, tilt_deg, count), random.uniform(0, 360, count)).T
    spin = np.radians(random.uniform(-tilt_deg, tilt_deg, count))
    lengths = strut_lengths(machine, tip, axis, spin, np.zeros(count))
    return MeasuredPoses(tip, axis, spin, np.zeros(count), lengths + random.normal(0, noise, lengths.shape))


@pytest.mark.slow
def test_with_noise_of_lengths_alone_it_is_the_linear_estimate(real):
    poses = measured(real)
    found = calibrate(real, poses)
    noise = noise_of_residuals(found)
    assert noise.length == pytest.approx(LENGTH_NOISE, rel=0.25)  # estimated from 102 spare lengths
    spread = calibration_uncertainty(found, poses, noise, runs=400).deviation
    # 400 runs give a standard deviation within 3.5 % (one sigma), the worst of 42 within four of these.
    assert spread / found.deviation == pytest.approx(1.0, abs=0.15)


@pytest.mark.slow
def test_the_tip_is_off_as_often_as_it_says(real):
    """Calibrate a machine that is known, by measurements with noise, and compare with what one of them predicts."""
    poses = measured(real, noise=0.0)
    stated = calibration_uncertainty(calibrate(real, poses), poses, TRACKER, runs=200)
    random, off = np.random.default_rng(5), []
    for _ in range(60):
        tip = poses.tip + random.normal(0, TRACKER.tip, poses.tip.shape)
        axis = poses.axis + random.normal(0, TRACKER.angle, poses.axis.shape)  # along the axis it has no effect
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
        spin = poses.spin + random.normal(0, TRACKER.angle, poses.spin.shape)
        lengths = poses.lengths + random.normal(0, TRACKER.length, poses.lengths.shape)
        again = calibrate(real, MeasuredPoses(tip, axis, spin, poses.tool_length, lengths))
        off.append(tip_distances(again.machine, real, poses))
    assert np.mean(np.array(off) < stated.tip_median) == pytest.approx(0.5, abs=0.1)
    assert np.mean(np.array(off) < stated.tip_most) == pytest.approx(0.95, abs=0.03)


def test_without_noise_nothing_is_off(real):
    poses = measured(real, noise=0.0)
    stated = calibration_uncertainty(calibrate(real, poses), poses, MeasurementNoise(0.0, 0.0, 0.0), runs=3)
    assert stated.deviation.max() < 1e-6
    assert stated.tip_most < 1e-6
    assert (stated.runs, stated.failed) == (3, 0)


def test_twice_the_noise_is_twice_the_spread(real):
    poses = measured(real)
    found = calibrate(real, poses)
    once, twice = (calibration_uncertainty(found, poses, MeasurementNoise(0, 0, noise), 40) for noise in (0.001, 0.002))
    assert twice.deviation / once.deviation == pytest.approx(2.0, rel=0.01)  # the same random numbers
    assert twice.tip_most / once.tip_most == pytest.approx(2.0, rel=0.01)


def test_what_poses_do_not_determine_does_not_vary(real):
    upright = measured(real, tilt_deg=0.0)
    found = calibrate(real, upright)
    assert found.undetermined
    stated = calibration_uncertainty(found, upright, MeasurementNoise(0, 0, LENGTH_NOISE), runs=20)
    assert stated.failed == 0
    assert stated.tip_most < 0.1


def test_noise_in_which_nothing_converges_leaves_nothing_known(real):
    poses = measured(real)
    stated = calibration_uncertainty(calibrate(real, poses), poses, MeasurementNoise(1e4, 1.0, 1e4), runs=3)
    assert stated.failed >= 2
    assert stated.tip_most == stated.deviation.min() == np.inf


def test_parameters_are_those_of_the_machine(real):
    off = dataclasses.replace(real, length_offset=real.length_offset + 1.0)
    assert (parameters_of(off) - parameters_of(real)).tolist() == [[0.0] * 6 + [1.0]] * 6


def test_arguments_without_sense_are_a_fault_of_the_caller(real):
    poses = measured(real)
    found = calibrate(real, poses)
    with pytest.raises(ValueError, match="2 or more"):
        calibration_uncertainty(found, poses, TRACKER, runs=1)
    with pytest.raises(ValueError, match="0 or above"):
        MeasurementNoise(-0.1, 0.0, 0.0)
    exact = dataclasses.replace(found, left_over=found.left_over[:0])
    assert noise_of_residuals(exact).length == 0.0


def test_the_command_reports_it(real, tmp_path, capsys):
    poses, out = measured(real), str(tmp_path / "mine.toml")
    table = np.column_stack([poses.tip, poses.axis, np.degrees(poses.spin), poses.tool_length, poses.lengths])
    path = tmp_path / "poses.csv"
    np.savetxt(path, table, delimiter=",", header=",".join(COLUMNS), comments="", fmt="%.9f")
    words = ["machine", "calibrate", "nategh_agheli_nominal", str(path), "--out", out]
    assert main([*words, "--runs", "20", "--noise", "0.01,0.001,0.002"]) == 0
    with_noise = capsys.readouterr().out
    assert "20 calibrations again, with noise of 0.01 mm, 0.001 deg and 0.002 mm in tip, axis and length" in with_noise
    assert "tool tip off by 0.0" in with_noise
    assert main([*words, "--runs", "20"]) == 0
    assert "with noise of 0 mm, 0 deg and 0.00" in capsys.readouterr().out
    assert main([*words, "--noise", "0.01,0.001,0.002"]) == 2
    assert "--runs" in capsys.readouterr().err
    for wrong in (["--runs", "1"], ["--runs", "5", "--noise", "1,2"], ["--runs", "5", "--noise", "1,2,nan"]):
        with pytest.raises(SystemExit):
            main([*words, *wrong])
        assert "expected" in capsys.readouterr().err
