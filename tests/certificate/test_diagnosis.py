# SPDX-License-Identifier: LGPL-2.1-or-later
"""Who is at fault when a limit is not kept: the decimals of the program, the plan, or whoever edited it."""

import dataclasses
import re
from functools import cache

import numpy as np
import pytest
from posted_jobs import NARROW, UNEQUAL, WIDE, planned, posted, preset, printed

from pkm_post.certificate import certify
from pkm_post.certificate.diagnosis import _further
from pkm_post.model import StrutMotion
from pkm_post.model.certificate import Tolerances

ASKED = Tolerances(1e-3, np.radians(1e-3))
ADVICE = re.compile(r"controller\.(\w+)_decimals = (\d)")


def with_decimals(name, decimals):
    """A preset that states these decimals."""
    machine = preset(name)
    length, speed = decimals
    return dataclasses.replace(
        machine, controller={**machine.controller, "length_decimals": length, "speed_decimals": speed}
    )


def advised(fault, decimals):
    """The decimals that a diagnostic asks for."""
    reported = dict(zip(("length", "speed"), decimals, strict=True)) | {
        name: int(digits) for name, digits in ADVICE.findall(fault.found)
    }
    return reported["length"], reported["speed"]


@cache
def faults_of(name, seed, tolerances, decimals):
    """The faults of a random job whose program has these decimals."""
    return printed(with_decimals(name, decimals), planned(name, seed, tolerances), tolerances, decimals)[-1]


SERIES = [
    (name, seed, tolerances, (length, speed))
    for name, seed, tolerances in (
        ("example_6tps", 29, NARROW),
        ("example_6tps", 3, WIDE),
        ("linuxcnc_genhexkins", 6, NARROW),
        ("nategh_agheli_nominal", 29, NARROW),
        ("nategh_agheli_nominal", 4, UNEQUAL),
    )
    for length, speed in ((6, 4), (5, 4), (4, 4), (6, 1), (3, 2), (2, 1))
]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "seed", "tolerances", "decimals"), SERIES)
def test_a_job_that_decimals_spoil_is_posted_with_those_advised(name, seed, tolerances, decimals):
    faults = faults_of(name, seed, tolerances, decimals)
    if posted(name, seed, tolerances, (9, 9))[-1] == ():
        assert {fault.code for fault in faults} <= {"V118"}
    for fault in faults[:1]:
        enough = advised(fault, decimals)
        assert enough != decimals and "without rounding" in fault.found
        assert faults_of(name, seed, tolerances, enough) == ()


@pytest.mark.slow
def test_the_series_has_jobs_that_are_refused_and_jobs_that_are_not():
    refused = [bool(faults_of(*job)) for job in SERIES]
    assert 5 < sum(refused) < len(refused) - 5


def test_an_edited_program_is_not_excused_by_its_decimals():
    machine, trajectory, motion, struts, certificate, _ = posted("example_6tps", 3, NARROW)
    assert certificate.holds
    wrong = struts.length.copy()
    wrong[len(wrong) // 2, 1] += 0.01
    edited = StrutMotion(struts.time_ms, wrong, struts.speed, struts.events)
    _, faults = certify(edited, "x.pmc", trajectory, machine, motion, ASKED)
    assert faults and "V118" not in {fault.code for fault in faults}
    assert not any("rounding" in fault.found for fault in faults)


@pytest.mark.slow
@pytest.mark.parametrize("decimals", [(6, 4), (1, 1)])
def test_a_plan_beyond_a_limit_stays_the_fault_of_the_planner(decimals):
    name = "example_6tps"
    slow = dataclasses.replace(with_decimals(name, decimals), strut_acceleration=500.0)
    machine, trajectory, motion, struts, *_ = posted(name, 3, WIDE, decimals)
    _, faults = certify(struts, "x.pmc", trajectory, slow, motion, Tolerances(0.2, np.radians(2)))
    fault = next(fault for fault in faults if fault.code == "V104")
    assert ("without rounding" in fault.found) == (decimals == (1, 1))


def test_no_more_decimals_are_tried_than_a_machine_file_may_state():
    assert max(max(one) for one in _further((8, 9))) == 9
    assert list(_further((9, 9))) == []
    assert list(_further((6, 4)))[:3] == [(7, 4), (6, 5), (7, 5)]
