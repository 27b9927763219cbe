# SPDX-License-Identifier: LGPL-2.1-or-later
"""What stands around the kinematic programs: axes, limits, segmentation, look-ahead and variables."""

from dataclasses import replace

import exported_machines as made
import numpy as np
import pytest
from kinematic_language import Controller

from pkm_post.writing.controllers.pmac.settings import PmacSettings, setup_text
from pkm_post.writing.kinematics.controller_file import Export, lookahead_segments


def lines(kind, machine=None, **export):
    """The lines outside of the programs, without comments."""
    return Controller(made.text_of(machine or made.example(), kind, **export), kind).on_line


def test_turbo_pmac_set_up_is_the_known_one():
    """500 mm/s and 5000 mm/s^2 at 10,000 counts/mm are 5000 counts/ms and 50 counts/ms^2."""
    found = lines("turbo", segment_time=10)
    first = ["CLOSE", "DELETE GATHER", "&1", *(f"#{motor}->I" for motor in range(1, 7)), "M145->Y:$0000C0,10,1"]
    assert [line for line in found if line != "CLOSE"][:9] == first[1:]
    expected = "M645->Y:$000340,10,1|M5182->Y:$00203F,22,1|DEFINE LOOKAHEAD 14,50|I15=0|I5190=1000|I5113=10|I5120=7"
    for line in [*expected.split("|"), "I116=5000", "I117=50", "I613=2421131", "I614=-2578869", "Q50=120", "Q56=10000"]:
        assert found.count(line) == 1, line
    # kinematics are off until both programs are there
    assert found.index("I5150=0") < found.index("I113=2421131") and found[-1] == "I5150=1"


def test_power_pmac_set_up_is_the_known_one():
    found = lines("power", segment_time=5)
    expected = (
        "#1->I|#6->I|Coord[1].FeedTime=1000|Coord[1].MaxFeedrate=250|Coord[1].SegMoveTime=5|Coord[1].LHDistance=14|"
        "Motor[1].MaxSpeed=5000|Motor[1].InvAmax=0.02|Motor[6].MaxPos=2421131|Motor[6].MinPos=-2578869|"
        "define lookahead 28"
    )
    for line in expected.split("|"):
        assert found.count(line) == 1, line


@pytest.mark.parametrize("system", [1, 2, 16])
def test_variables_and_addresses_are_those_of_the_coordinate_system(system):
    """Isx13 is I5113 in the first and I6613 in the last; their run-time error bits are 0x100 apart."""
    stated = made.example()
    machine = replace(stated, controller=stated.controller | {"coordinate_system": system})
    found = lines("turbo", machine)
    assert f"&{system}" in found and f"I{50 + system}13=10" in found
    error = {1: "M5182->Y:$00203F,22,1", 2: "M5282->Y:$00213F,22,1", 16: "M6682->Y:$002F3F,22,1"}[system]
    assert error in found
    programs = Controller(made.text_of(machine, "turbo"), "turbo").programs["forward"]
    assert f"{error[:5]}=1" in programs


def test_look_ahead_is_that_of_the_manuals_example():
    """400 counts/ms, 1 count/ms^2 and segments of 5 ms: 54 segments [Turbo PMAC Software Reference, Isx20]."""
    machine = replace(made.example(), strut_speed=40.0, strut_acceleration=100.0)
    assert lookahead_segments(machine, Export(5, 120.0)) == 54


def test_soft_limits_are_those_of_the_set_up_of_programs():
    settings = PmacSettings.of(made.calibrated().controller)
    posted = Controller(setup_text(settings, "test", (750.0, 1250.0)), "turbo").on_line
    found = lines("turbo", made.calibrated())
    limits = [f"I{motor}{which}" for motor in range(1, 7) for which in (13, 14)]
    assert [line for line in found if line.split("=")[0] in limits] == [
        line for line in posted if line.split("=")[0] in limits
    ]


def test_counts_that_fall_as_a_strut_extends_keep_rates_positive():
    assert {"I116=4096", "I117=40.96", "Q56=-8192"} <= set(lines("turbo", made.calibrated()))


def test_variables_hold_the_machine_to_the_last_digit():
    machine = made.screwed()
    values = Controller(made.text_of(machine, "power"), "power").values
    for strut in range(6):
        own = [values[f"Q{100 + 20 * strut + place}"] for place in range(14)]
        stated = [
            machine.base_joints[strut], machine.platform_joints[strut], [machine.length_offset[strut]],
            [machine.controller["zero_length"][strut]], machine.base_axes[strut], machine.platform_axes[strut],
        ]  # fmt: skip
        assert own == np.concatenate(stated).tolist()
    assert values["Q57"] == machine.screw_lead / 360
