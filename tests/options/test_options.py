# SPDX-License-Identifier: LGPL-2.1-or-later
"""The arguments of every way into PKM Post become options in mm and rad."""

import argparse
import json
from dataclasses import replace

import numpy as np
import pytest

from pkm_post.machine import ZERO_TORSION, SpinPolicy, SpinRule
from pkm_post.machine.spin.policy import OBJECTIVES
from pkm_post.options import (
    FIXTURE_OF_THE_JOB,
    SPIN_WORDS,
    add_options,
    converters,
    options_from,
    part_program_from,
    tool_lengths_from,
)
from pkm_post.options.choices import Options
from pkm_post.options.conversion import argument_values, tools_from
from pkm_post.reading import cldata
from pkm_post.reading.part_program import AS_WRITTEN
from pkm_post.toolpath.compensation.offset_options import OffsetOptions
from pkm_post.toolpath.from_line import StartLine
from pkm_post.toolpath.surface_speed import SurfaceSpeed


def parsed(*words):
    parser = argparse.ArgumentParser()
    add_options(parser)
    return parser.parse_args(words)


def test_defaults_are_those_of_the_pipeline():
    chosen = options_from(parsed())
    assert (chosen.tip_tolerance, chosen.axis_tolerance) == (Options().tip_tolerance, Options().axis_tolerance)
    assert chosen.work_offset == FIXTURE_OF_THE_JOB
    assert parsed().machine == "example_6tps"
    assert tool_lengths_from(parsed()) == {}


def test_degrees_become_radians():
    assert options_from(parsed("--axis-tolerance", "0.5")).axis_tolerance == pytest.approx(np.pi / 360)


def test_work_offset_by_name():
    assert options_from(parsed("--work-offset", "G55")).work_offset == "G55"


def test_work_offset_as_a_pose():
    # x to the table's y: a quarter turn, then the shift
    pose = options_from(parsed("--work-offset=-10,20,150.5,90")).work_offset
    np.testing.assert_allclose(pose @ [1, 0, 0, 1], [-10, 21, 150.5, 1], atol=1e-12)
    np.testing.assert_allclose(options_from(parsed("--work-offset", "1,2,3")).work_offset[:3, 3], [1, 2, 3])


def test_a_pose_of_a_macro_may_be_lists_and_does_not_change_later():
    pose = np.diag([1.0, 1.0, 1.0, 1.0])
    pose[:3, 3] = 1, 2, 3
    chosen = [Options(work_offset=pose), Options(work_offset=pose.tolist()), Options(work_offset=pose.astype(int))]
    pose[0, 3] = 7
    for each in chosen:
        assert argument_values(each)["work_offset"] == (1, 2, 3, 0) and not each.work_offset.flags.writeable


def test_numbers_of_numpy_are_those_of_a_report():
    chosen = Options(tip_tolerance=np.float32(0.25), axis_tolerance=np.float16(0.5))
    assert json.dumps([chosen.tip_tolerance, chosen.axis_tolerance]) == "[0.25, 0.5]"


def test_what_a_part_program_does_not_say():
    words = ["--unit", "inch", "--contour-data=centre", "--wear=3=-0.05", "--wear=3=0.1", "--tool=3=8"]
    reading = part_program_from(parsed(*words), "vector")
    assert (reading.axis_words, reading.unit, reading.contour_data) == ("vector", "inch", "centre")
    assert (reading.wear, reading.tools[3].diameter) == ({3: 0.1}, 8)
    assert part_program_from(parsed(), "none") == AS_WRITTEN
    assert part_program_from(parsed("--allow-open-end"), "none").allow_open_end
    reading = part_program_from(parsed("--cl-dialect=creo", "--cycle-values=depth,feed,clearance"), "none")
    assert (reading.cl_dialect, reading.cycle_values) == ("creo", ("depth", "feed", "clearance"))


def test_what_cl_data_may_be_said_to_be_is_what_its_reader_knows():
    assert (*cldata.DIALECTS,) == converters.CL_DIALECTS
    assert converters.CYCLE_VALUES == cldata.CYCLE_VALUES
    assert converters.GOTO_VALUES == cldata.GOTO_VALUES


@pytest.mark.parametrize("names", ["depth,feed,depth", "depth,height", "", "depth,"])
def test_values_of_cycles_are_different_names(names):
    with pytest.raises(SystemExit):
        parsed("--cycle-values", names)


def test_tool_lengths():
    namespace = parsed("--tool-length", "1=120", "--tool-length", "12=85.25", "--tool-length", "1=121")
    assert tool_lengths_from(namespace) == {1: 121, 12: 85.25}


def test_compensation():
    chosen = options_from(parsed("--corners", "arc", "--leads", "B", "--actual-tool", "3=11.9,5.95"))
    assert chosen.contours == OffsetOptions(corners="arc", leads="B")
    assert (chosen.actual_tools[3].diameter, chosen.actual_tools[3].corner_radius) == (11.9, 5.95)
    assert options_from(parsed()).contours == OffsetOptions()
    assert not options_from(parsed()).actual_tools


def test_cutters_keep_whether_their_corner_was_given():
    given = tools_from(parsed("--tool", "1=10", "--tool", "2=10,0", "--tool", "3=8,4", "--tool", "3=9.6,4.8"))
    assert {number: (tool.diameter, tool.corner_radius, tool.corner_known) for number, tool in given.items()} == {
        1: (10.0, 0.0, False),
        2: (10.0, 0.0, True),
        3: (9.6, 4.8, True),
    }


def test_surface_speed():
    assert options_from(parsed()).surface_speed is None
    wanted = options_from(parsed("--surface-speed", "120", "--keep-chip-load")).surface_speed
    assert wanted == SurfaceSpeed(2000.0, keep_chip_load=True)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [("12", StartLine(12)), ("Finish: inside:3", StartLine(3, "Finish: inside")), (":7", StartLine(7)), ("none", None)],
)
def test_a_line_to_begin_at(text, wanted):
    chosen = options_from(parsed("--from-line", text))
    assert chosen.from_line == wanted and options_from(parsed()).from_line is None
    assert argument_values(chosen)["from_line"] == (None if wanted is None else (wanted.line, wanted.operation))
    repeated = options_from(parsed("--from-line", text, "--repeat-codes"))
    assert repeated.from_line == (None if wanted is None else replace(wanted, repeat_codes=True))
    assert argument_values(repeated)["repeat_codes"] == (wanted is not None)


def test_every_rule_of_the_spin_can_be_chosen():
    assert set(converters._SPINS) == {rule.value for rule in SpinRule}
    assert set(converters.OBJECTIVES) == set(OBJECTIVES)
    assert {options_from(parsed("--spin", rule)).spin.rule for rule in converters._SPINS} == set(SpinRule)
    assert options_from(parsed()).spin == ZERO_TORSION


def test_the_numbers_of_the_spin():
    assert options_from(parsed("--spin", "x-in-plane=-90")).spin.heading == pytest.approx(-np.pi / 2)
    assert options_from(parsed("--spin=optimise=singular")).spin == SpinPolicy(SpinRule.OPTIMISED, objective="singular")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--actual-tool", "3"], "expected NUMBER=D[,R], got '3'"),
        (["--actual-tool", "T3=10"], "expected NUMBER=D[,R], got 'T3=10'"),
        (["--spin", "fast"], "expected one of zero, file, x-in-plane[=DEG]"),
        (["--spin", "zero=1"], "got 'zero=1'"),
        (["--spin", "x-in-plane=x"], "expected a number, got 'x'"),
        (["--copies", "xz,a"], "expected xy, xz, yz or an angle within 360 degrees, got 'a'"),
        (["--spin", "optimise=x"], "expected one of stroke, joints, singular, weighted after =, got 'x'"),
        (["--tip-tolerance", "0"], "expected a number from 1e-06 to 100, got '0'"),
        (["--tip-tolerance", "1e-15"], "expected a number from 1e-06 to 100, got '1e-15'"),
        (["--tip-tolerance", "nan"], "expected a number from 1e-06 to 100, got 'nan'"),
        (["--axis-tolerance", "x"], "expected a number from 1e-06 to 45, got 'x'"),
        (["--axis-tolerance", "1e300"], "expected a number from 1e-06 to 45, got '1e300'"),
        (["--surface-speed", "1e308"], "expected a number above 0 and up to 100000, got '1e308'"),
        (["--from-line", "0"], "expected N or OPERATION:N, a line from 1 on, got '0'"),
        (["--from-line", "Finish"], "expected N or OPERATION:N, a line from 1 on, got 'Finish'"),
        (["--from-line", "Finish:-3"], "expected N or OPERATION:N, a line from 1 on, got 'Finish:-3'"),
        (["--actual-tool", "3=1e300"], "expected a number above 0 and up to 10000, got '1e300'"),
        (["--actual-tool", "3=10,-1"], "expected a number from 0 to 5.0, got '-1'"),
        (["--tool", "3=10,5.001"], "expected a number from 0 to 5.0, got '5.001'"),
        (["--tool", "3=10,"], "expected a number from 0 to 5.0, got ''"),
        (["--tool", "3"], "expected NUMBER=D[,R], got '3'"),
        (["--work-offset", "1e300,0,0"], "expected a number from -1000000 to 1000000, got '1e300'"),
        (["--work-offset", "1,2"], "expected X,Y,Z or X,Y,Z,DEG, got '1,2'"),
        (["--work-offset", "1,2,"], "expected a number from -1000000 to 1000000, got ''"),
        (["--work-offset", "1,2,3,x"], "expected a number, got 'x'"),
        (["--tool-length", "120"], "expected NUMBER=MM, got '120'"),
        (["--tool-length", "T1=120"], "expected NUMBER=MM, got 'T1=120'"),
        (["--tool-length", "1=-5"], "expected a number above 0 and up to 10000, got '-5'"),
        (["--tool-length", "1=2000000000"], "expected a number above 0 and up to 10000, got '2000000000'"),
    ],
)
def test_what_makes_no_sense_is_reported(arguments, message, capsys):
    with pytest.raises(SystemExit):
        parsed(*arguments)
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("word", SPIN_WORDS)
def test_every_spin_that_is_offered_is_understood(word):
    rule, _, objective = parsed("--spin", word).spin
    assert word == (f"{rule}={objective}" if rule == "optimise" else rule)
