# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs with several fixtures: cut in CAM's order, each where its work offset is, with one certificate."""

import math
import re

import numpy as np
import pytest
from cam_jobs import BELOW, add_operation, add_tool_controller, job_in_reach
from Path.Post.Processor import PostProcessor, PostProcessorFactory

import pkm_post.freecad_app.job_setup as job_setup
from pkm_post.freecad_app.fixtures import cutting_order, operation_named
from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.job_setup import placed_job, prepared_job
from pkm_post.freecad_app.material import material_of
from pkm_post.freecad_app.post_job import post_job
from pkm_post.freecad_app.simulation import simulate_job
from pkm_post.model import Refused
from pkm_post.posting import no_progress
from pkm_post.writing import trajectory_file

CUT = ["G0 Z10", "G0 X0 Y0", "G1 Z0 F5", "G1 X10 Y5", "G0 Z10"]
TILTED = ["G0 Z30 I0 J0 K1", "G0 X2 Y3 Z30 I0 J0 K1", "G1 X2 Y3 Z25 I0 J0.28 K0.96 F20", "G0 Z30 I0 J0 K1"]
SECOND = (25.0, 10.0, 5.0, 90.0)
"""Where the second fixture is in {C}: mm, and degrees about z."""
ORIGIN = "--origin=G55=25,10,5,90"


@pytest.fixture
def job(document):
    made = job_in_reach(document, BELOW)
    made.Fixtures = ["G54", "G55"]
    made.PostProcessorArgs += f" {ORIGIN}"
    add_operation(made, CUT, "First")
    return made


def prepared(job):
    return prepared_job(job, settings_of(job))


def refused(job):
    with pytest.raises(Refused) as fault:
        _ = prepared(job).sound
    return [each.code for each in fault.value.diagnostics]


def at_second(points):
    """Points of the second fixture in {C}, by the law of a turn and a shift."""
    x, y, z, degrees = SECOND
    angle = math.radians(degrees)
    turned = [(math.cos(angle) * a - math.sin(angle) * b, math.sin(angle) * a + math.cos(angle) * b, c)
              for a, b, c in points]  # fmt: skip
    return np.array(turned) + [x, y, z]


def test_every_operation_is_cut_at_every_fixture(job):
    program, _ = prepared(job).sound
    assert program.operations == ("First", "First (G55)")
    assert program.reading == ("operations of the job: 1 listed, 1 meant and active, 2 read at 2 fixtures",)
    first, second = (program.position[program.operation == each] for each in (0, 1))
    cut = [(0, 0, 10), (0, 0, 0), (10, 5, 0), (10, 5, 10)]
    np.testing.assert_allclose(first[-4:], cut, atol=1e-9)
    np.testing.assert_allclose(second[-4:], at_second(cut), atol=1e-9)
    # the first move goes up where the tool is, to the height of the second fixture, as a control would do it
    np.testing.assert_allclose(second[0], [10, 5, 15], atol=1e-9)


def test_tool_axes_turn_with_the_fixture(job):
    add_operation(job, TILTED, "Tilted")
    program, _ = prepared(job).sound
    first, second = (program.tool_axis[program.operation == program.operations.index(name)]
                     for name in ("Tilted", "Tilted (G55)"))  # fmt: skip
    np.testing.assert_allclose(first[-2], [0, 0.28, 0.96], atol=1e-9)
    np.testing.assert_allclose(second[-2], [-0.28, 0, 0.96], atol=1e-9)


@pytest.mark.parametrize("order", ["Fixture", "Tool", "Operation"])
def test_the_order_is_that_of_cam(job, order):
    other = add_tool_controller(job, 2)
    for label, controller in (("Second", job.Tools.Group[0]), ("Third", other), ("Fourth", job.Tools.Group[0])):
        add_operation(job, CUT, label).ToolController = controller
    job.Document.recompute()
    job.OrderOutputBy = order
    ((_, items),) = PostProcessor(job, "", "", "")._buildPostList()
    fixture, by_cam = None, []
    for item in items:
        codes = [command.Name for command in item.Path.Commands if re.fullmatch(r"G5\d.*", command.Name)]
        fixture = codes[0] if codes else fixture
        if item in job.Operations.Group:
            by_cam.append((fixture, item))
    assert cutting_order(job.Operations.Group, job.Fixtures, order) == by_cam
    program, _ = prepared(job).sound
    assert program.operations == tuple(
        each.Label if fixture == "G54" else f"{each.Label} (G55)" for fixture, each in by_cam
    )


def test_part_and_stock_are_at_every_fixture(job):
    setup = placed_job(job).setup
    corners = setup.part.triangles
    half = len(corners) // 2
    np.testing.assert_allclose(corners[half:].reshape(-1, 3), at_second(corners[:half].reshape(-1, 3)), atol=1e-9)
    assert len(setup.stock.triangles) == 2 * 12


def test_one_certificate_holds_for_all_fixtures(job, tmp_path):
    posted = post_job(job, out=tmp_path)
    assert posted.report["certificate"]["holds"]
    stored, _ = trajectory_file.read(tmp_path / "part.pkmt")
    np.testing.assert_allclose(stored.tip[-1], at_second([(10, 5, 10)])[0] + [0, 0, 250], atol=1e-9)
    assert stored.operations == ("First", "First (G55)")


def test_g_code_has_all_fixtures_in_the_frame_of_the_first(job):
    written = PostProcessorFactory.get_post_processor(job, "hexapod_gcode").export()[0][1]
    words = {letter: re.findall(rf"{letter}(-?[\d.]+)", written)[-1] for letter in "XYZ"}
    np.testing.assert_allclose([float(words[letter]) for letter in "XYZ"], at_second([(10, 5, 10)])[0], atol=1e-6)


def test_the_machine_file_knows_where_a_fixture_is(job, tmp_path):
    machine = job_setup.find_machine("example_6tps").read_text(encoding="utf-8")
    file = tmp_path / "machine.toml"
    place = "G55 = { origin = [25.0, 10.0, 255.0], rotation_z = 90.0 }\n"
    file.write_text(machine.replace("[work_offsets]\n", f"[work_offsets]\n{place}"), encoding="utf-8")
    wanted, _ = prepared(job).sound
    job.PostProcessorArgs = f"--machine {file} --work-offset=0,0,250"
    found, _ = prepared(job).sound
    np.testing.assert_allclose(found.position, wanted.position, atol=1e-9)
    job.PostProcessorArgs += " --origin=G55=25,10,6,90"  # of the option, not of the file
    assert prepared(job).sound[0].position[-1, 2] == pytest.approx(wanted.position[-1, 2] + 1)


def test_a_fixture_without_a_place_is_refused(job):
    job.PostProcessorArgs = job.PostProcessorArgs.replace(ORIGIN, "")
    assert refused(job) == ["K108"]


def test_two_fixtures_in_one_place_are_refused(job):
    job.PostProcessorArgs = job.PostProcessorArgs.replace(ORIGIN, "--origin=G55=0,0,0")
    assert refused(job) == ["J111"]


def test_fixtures_a_few_microns_apart_are_two_places(job):
    origins = "--origin=G55=200,0,0 --origin=G56=200.0015,0,0"  # mm
    job.Fixtures, job.PostProcessorArgs = ["G54", "G55", "G56"], job.PostProcessorArgs.replace(ORIGIN, origins)
    assert "J111" not in [each.code for each in prepared(job).found]


@pytest.mark.parametrize(("order", "files"), [("Fixture", 2), ("Tool", 1), ("Operation", 3)])
def test_split_output_is_not_followed_in_silence(job, order, files):
    for label in ("Second", "Third"):
        add_operation(job, CUT, label)
    job.SplitOutput, job.OrderOutputBy = True, order
    assert len(PostProcessor(job, "", "", "")._buildPostList()) == files
    found = [each.found for each in prepared(job).found if each.code == "J140"]
    assert found == ([f"{files} files by {order}"] if files > 1 else [])


def test_g54_in_an_operation_at_another_fixture_is_refused(job):
    # CAM's own posts write it behind the G55 of the job: the moves after it would be at G54
    add_operation(job, ["G54", *CUT], "Typed")
    assert refused(job) == ["J104"]
    job.PostProcessorArgs = job.PostProcessorArgs.replace(ORIGIN, "")
    job.Fixtures = ["G55"]
    assert refused(job) == ["J104"]
    job.Fixtures = ["G54"]
    assert prepared(job).sound[0].operations == ("First", "Typed")


def test_copies_of_all_fixtures_are_refused(job):
    job.PostProcessorArgs += " --copies=xz"
    assert refused(job) == ["J139"]


def test_a_place_that_no_fixture_has_is_a_warning(job):
    job.PostProcessorArgs += " --origin=G54=1,2,3 --origin=G56=1,2,3"
    assert [each.found for each in prepared(job).found] == ["--origin G54", "--origin G56"]


def test_a_fault_of_an_operation_is_said_once(job):
    add_operation(job, ["G0 Z5", "G86 X1"], "Faulty")
    assert refused(job) == ["J104"]


def test_names_lead_back_to_the_operations(job):
    (operation,) = job.Operations.Group
    assert operation_named(job, "First") == operation_named(job, "First (G55)") == operation
    assert operation_named(job, "First (G56)") is None


def test_a_place_that_was_found_takes_all_fixtures_along(job):
    job.PostProcessorArgs = job.PostProcessorArgs.replace("0,0,250", "0,0,700")
    before, _ = prepared(job).sound
    found = job_setup.place_search(job)(no_progress)
    assert found.holds
    job_setup.set_place(job, found)
    after, _ = prepared(job).sound
    np.testing.assert_allclose(after.position, before.position, atol=1e-3)
    assert placed_job(job).study().holds


def test_the_simulation_cuts_a_stock_at_every_fixture(document):
    job = job_in_reach(document, 20.0)
    job.PostProcessorArgs += " --origin=G55=60,0,0"
    add_operation(job, ["G0 Z30", "G0 X10 Y10", "G1 Z12 F5", "G1 X15", "G0 Z30"], "Slot")
    stock, taken = [], []
    for fixtures in (["G54"], ["G54", "G55"]):
        job.Fixtures = fixtures
        plan = simulate_job(job)
        replay = material_of(plan, 0.5).replay
        stock.append(replay.stock.volume)
        replay.go_to(plan.duration)
        taken.append(stock[-1] - replay.stock.volume)
    assert stock[1] == pytest.approx(2 * stock[0], rel=0.005)
    assert taken[1] == pytest.approx(2 * taken[0], rel=0.02) and taken[0] > 100.0
