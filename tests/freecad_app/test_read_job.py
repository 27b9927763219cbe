# SPDX-License-Identifier: LGPL-2.1-or-later
"""A CAM job becomes one program: order, placements, tools, events, and everything that can be wrong with a job."""

import FreeCAD as App
import numpy as np
import Part
import Path
import Path.Main.Job
import Path.Op.Adaptive
import Path.Op.Probe
import pytest
from cam_jobs import ARC, FIVE_AXIS, add_operation, add_tool_controller, moves, turn
from part_jobs import job_on
from test_dressups_of_cam import operation_on
from test_tools import stock_bit

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.job_setup import prepared_job
from pkm_post.freecad_app.symmetry import create_mirror
from pkm_post.freecad_app.tools import preselected, set_gauge_length
from pkm_post.model import EventKind, Kind

SIX_DECIMALS = 1e-6
TOOL, SPINDLE, COOLANT, DWELL, STOP = (
    EventKind.TOOL_CHANGE,
    EventKind.SPINDLE,
    EventKind.COOLANT,
    EventKind.DWELL,
    EventKind.STOP,
)


def program_of(job, **lengths):
    job.Document.recompute()
    program, faults = read_job(job, **lengths)
    assert faults == ()
    return program


def events(program):
    return [(event.row, event.kind, event.value) for event in program.events]


def faults_of(job):
    job.Document.recompute()
    program, faults = read_job(job)
    assert (program is None) == any(fault.severity.value == "error" for fault in faults)
    return [(fault.code, fault.place.operation, fault.place.line) for fault in faults]


def test_operations_follow_each_other_in_the_order_of_the_tree(job):
    add_operation(job, FIVE_AXIS, "First")
    add_operation(job, ARC, "Second")
    program = program_of(job)
    assert program.operations == ("First", "Second")
    np.testing.assert_array_equal(program.operation, [0] * 4 + [1] * 6)
    np.testing.assert_array_equal(program.line[:4], [3, 4, 5, 6])  # after (First) and (Begin Custom)
    assert str(program.place(1)) == "part: First: line 4"
    np.testing.assert_array_equal(program.feed[1:3], [20, 25])


def test_next_operation_retracts_from_where_the_last_one_ended(job):
    # G0 Z10 first, as CAM writes it: straight up, not aslant through the part.
    add_operation(job, ["G0 X5 Y6 Z7", "G1 Z0 F1"], "First")
    add_operation(job, ["G0 Z10", "G0 X20 Y20", "G1 Z0 F1"], "Second")
    np.testing.assert_array_equal(program_of(job).position[1:4], [[5, 6, 0], [5, 6, 10], [20, 20, 10]])


def test_inactive_operations_are_left_out(job):
    add_operation(job, FIVE_AXIS, "First")
    last = add_operation(job, ARC, "Second")
    last.Active = False
    job.OrderOutputBy = "Tool"  # with which FreeCAD 1.0 would lose the first one, too
    job.Document.recompute()
    assert program_of(job).operations == ("First",)


def test_placement_moves_points_and_turns_tool_axes(job):
    operation = add_operation(job)
    before = program_of(job)
    operation.Placement = App.Placement(App.Vector(100, 0, 5), App.Rotation(App.Vector(0, 0, 1), 90))
    after = program_of(job)
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    np.testing.assert_allclose(after.position, before.position @ turn.T + [100, 0, 5], atol=1e-12)
    np.testing.assert_allclose(after.tool_axis, before.tool_axis @ turn.T, atol=1e-12)


def test_retract_with_a_placement(job):
    add_operation(job, ["G0 X5 Y6 Z7", "G1 Z0 F1"], "First")
    second = add_operation(job, ["G0 Z10", "G0 X20 Y20", "G1 Z0 F1"], "Second")
    second.Placement.Base = App.Vector(0, 0, 3)
    np.testing.assert_allclose(program_of(job).position[2:4], [[5, 6, 13], [20, 20, 13]])


def test_tool_spindle_and_coolant_start_with_the_program_and_end_with_it(job):
    add_operation(job, FIVE_AXIS).CoolantMode = "Mist"
    assert events(program_of(job)) == [
        (0, TOOL, 1),
        (0, SPINDLE, 9000),
        (0, COOLANT, 2),
        (4, SPINDLE, 0),
        (4, COOLANT, 0),
    ]


def test_operations_with_the_same_tool_change_nothing(job):
    for label in ("First", "Second"):
        add_operation(job, label=label)
    assert [event[0] for event in events(program_of(job))] == [0, 0, 8]


def test_spindle_and_coolant_stop_for_a_tool_change(job):
    first, second = add_operation(job, label="First"), add_operation(job, label="Second")
    second.ToolController = add_tool_controller(job, 7)
    turn(second.ToolController, "Reverse")
    first.CoolantMode = second.CoolantMode = "Flood"
    program = program_of(job)
    assert events(program)[3:8] == [
        (4, SPINDLE, 0),
        (4, COOLANT, 0),
        (4, TOOL, 7),
        (4, SPINDLE, -5000),
        (4, COOLANT, 1),
    ]
    assert {number: tool.length for number, tool in program.tools.items()} == {1: 120, 7: 107}


def test_flood_stops_where_an_operation_wants_mist(job):
    """M7 does not end M8 [LinuxCNC, M7, M8, M9]; CAM's own posts write M9 after each operation with coolant."""
    first, second = add_operation(job, label="First"), add_operation(job, label="Second")
    first.CoolantMode, second.CoolantMode = "Flood", "Mist"
    assert [each for each in events(program_of(job)) if each[1] is COOLANT] == [
        (0, COOLANT, 1),
        (4, COOLANT, 0),
        (4, COOLANT, 2),
        (8, COOLANT, 0),
    ]


def test_same_tool_with_another_speed_is_not_changed(job):
    add_operation(job, label="First")
    slow = add_tool_controller(job, 1)
    slow.Tool = job.Tools.Group[0].Tool
    set_gauge_length(slow, 120)
    add_operation(job, label="Second").ToolController = slow
    assert events(program_of(job))[1:] == [(0, SPINDLE, 9000), (4, SPINDLE, 5000), (8, SPINDLE, 0)]


def test_events_of_an_operation_come_in_between(job):
    add_operation(job, [*FIVE_AXIS[:2], "G4 P0.5", "M5", *FIVE_AXIS[2:]], "First")
    add_operation(job, FIVE_AXIS, "Second")
    program, faults = read_job(job)
    assert [fault.found for fault in faults] == ["M5, until Second"]
    assert events(program)[2:] == [
        (2, DWELL, 0.5),
        (2, SPINDLE, 0),
        (4, SPINDLE, 9000),
        (8, SPINDLE, 0),
    ]


def switched_back(job):
    """What the reader says of events in operations that end at the next one."""
    return [(fault.code, fault.place.operation, fault.found) for fault in read_job(job)[1]]


@pytest.mark.parametrize("code", ["M3 S800", "M4 S9000", "M5", "M7", "M8"])
def test_what_an_operation_leaves_switched_is_switched_back_with_a_warning(job, code):
    """CAM's own posts keep it until the tool controller changes."""
    first = add_operation(job, [*FIVE_AXIS, code], "First")
    add_operation(job, FIVE_AXIS, "Second")
    add_operation(job, FIVE_AXIS, "Third")
    assert switched_back(job) == [("J145", "First", f"{code}, until Second")]
    first.Gcode = [code]
    job.Document.recompute()
    assert switched_back(job) == [("J145", "First", f"{code}, until Second")]


@pytest.mark.parametrize(("order", "until"), [("Fixture", "Second"), ("Tool", "Second"), ("Operation", "First (G55)")])
def test_what_is_switched_back_at_several_fixtures_is_told_once(job, order, until):
    add_operation(job, [*FIVE_AXIS, "M5"], "First")
    add_operation(job, FIVE_AXIS, "Second")
    job.Fixtures, job.OrderOutputBy = ["G54", "G55", "G56"], order
    assert switched_back(job) == [("J145", "First", f"M5, until {until}")]


def test_no_warning_where_cams_own_posts_switch_it_too(job):
    first = add_operation(job, [*FIVE_AXIS, "M3 S800", "M7"], "First")
    first.CoolantMode = "Flood"
    second = add_operation(job, ["M3 S700", *FIVE_AXIS, "M3 S9000", "M9"], "Second")
    third = add_operation(job, [*FIVE_AXIS, "M3 S800", "M8"], "Third")
    second.CoolantMode = third.CoolantMode = "Flood"
    add_operation(job, FIVE_AXIS, "Fourth").ToolController = add_tool_controller(job, 7)
    job.Document.recompute()
    assert switched_back(job) == []


def test_an_adaptive_operation_that_was_stopped_is_refused(document, monkeypatch):
    """CAM makes a path of what it has when the user presses Stop, and calls it up to date."""
    block = Part.makeBox(40, 30, 20).cut(Part.makeBox(20, 14, 10, App.Vector(10, 8, 10)))
    job = job_on(document, block, "endmill.fcstd", Diameter=6)
    generate = Path.Op.Adaptive.GenerateGCode

    def stopped(op, obj, *results):
        obj.StopProcessing = True
        return generate(op, obj, *results)

    monkeypatch.setattr(Path.Op.Adaptive, "GenerateGCode", stopped)
    adaptive = operation_on(job, "Adaptive", lambda box: box.ZLength < 0.01 and abs(box.ZMax - 10) < 0.01)
    assert adaptive.Path.Size > 10
    assert [(fault.code, fault.found) for fault in read_job(job)[1]] == [("J116", "its computation was stopped")]
    monkeypatch.undo()
    adaptive.touch()
    assert faults_of(job) == []


TYPED = ["(a move (to the left))", "", "G0 X0 Y0 Z5", "g01 x1.5Y-.5 F+5 ;", "G1 X 3. Z2", "G4P.5"]


@pytest.mark.parametrize("line", ["G1 X1,5", "G1 X5 (left)", "; G1 X5", "/G1 X5", "G1 X5 X6", "G1 X[2+3]", "G1 X5 Y"])
@pytest.mark.parametrize("source", ["Text", "File"])
def test_typed_lines_that_freecad_reads_otherwise_are_refused(job, tmp_path, line, source):
    """FreeCAD takes them for X15, a comment, a move, a move, X6 and X23, and 1.1 leaves the last one out."""
    cut = add_operation(job, TYPED, "Cut")
    cut.Source, cut.GcodeFile = source, str(tmp_path / "typed.nc")
    written = (tmp_path / "typed.nc").write_text
    written("%\n" + "\n".join(TYPED))
    cut.touch()
    job.Document.recompute()
    assert program_of(job).position[-1].tolist() == [3, -0.5, 2]
    written("\n".join([*TYPED, line]))
    cut.Gcode = [*TYPED, line]
    job.Document.recompute()
    program, (fault,) = read_job(job)
    assert program is None
    if cut.isValid():
        told = "behind the last line its path has G1 X5.000000" if line.startswith(";") else f"line 7, {line!r}"
        assert fault.code == "J146" and told in fault.found
    else:  # FreeCAD 1.0 leaves only lines of files out
        assert (fault.code, line, source) == ("J116", "G1 X5 Y", "Text")


def test_a_custom_operation_is_compared_with_its_file_as_it_is(job, tmp_path):
    """Below a copy, too; a file that is gone leaves FreeCAD 1.1 with a path of comments."""
    file = tmp_path / "typed.nc"
    file.write_text("\n".join(TYPED))
    cut = add_operation(job, [], "Cut")
    cut.Source, cut.GcodeFile = "File", str(file)
    create_mirror(cut, (1, 0, 0))
    job.Document.recompute()
    assert program_of(job) is not None
    file.write_text("\n".join([*TYPED[:-1], "G4 P2"]))
    assert {fault.code for fault in read_job(job)[1]} == {"J146"}
    file.unlink()
    assert [fault.found for fault in read_job(job)[1]] == [f"{file} cannot be read"] * 2


def test_stop_between_operations(job):
    add_operation(job, label="First")
    second = add_operation(job, label="Second")
    stop = job.Document.addObject("Path::Feature", "Stop")
    stop.Path = Path.Path([Path.Command("M0")])
    job.Proxy.addOperation(stop, second)
    assert (4, STOP, 0) in events(program_of(job))


def test_tool_called_by_an_m6_is_known_to_the_program(job):
    add_operation(job, [*FIVE_AXIS[:1], "M6 T7", *FIVE_AXIS[1:]])
    add_tool_controller(job, 7)
    program = program_of(job)
    assert sorted(program.tools) == [1, 7]
    assert (1, TOOL, 7) in events(program)


def test_gauge_length_given_goes_before_that_of_the_controller(job):
    add_operation(job)
    assert program_of(job, tool_lengths={1: 95.5}).tools[1].length == 95.5


def test_saved_jobs_carry_the_file_name(job, tmp_path):
    add_operation(job)
    job.Document.saveAs(str(tmp_path / "a part.FCStd"))
    assert program_of(job).source == "a part.FCStd"


# What can be wrong


def test_job_without_operations(job):
    assert faults_of(job) == [("J103", "Job", 0)]


def test_job_with_nothing_but_inactive_operations(job):
    add_operation(job).Active = False
    job.Document.recompute()
    assert faults_of(job) == [("J103", "Job", 0)]


def probe(job, bit):
    """CAM's own probing of the stock, at its four corners."""
    job.Tools.Group[0].Tool = stock_bit(job.Document, bit)
    operation = job.Document.addObject("Path::FeaturePython", "Probe")
    with preselected(job.Tools.Group[0]):
        operation.Proxy = Path.Op.Probe.ObjectProbing(operation, "Probe", job)
    operation.ToolController, operation.PointCountX, operation.PointCountY = job.Tools.Group[0], 2, 2
    job.Document.recompute()
    return operation


def test_probing_is_refused_by_name(job):
    operation = probe(job, "probe.fcstd")
    (fault,) = read_job(job)[1]
    assert (
        fault.code == "J142"
        and fault.place.operation == operation.Label
        and fault.found.startswith("G38.2, and 3 more")
    )


def test_an_operation_that_cuts_nothing_is_named_alone_and_among_others(job):
    probe(job, "endmill.fcstd")  # CAM warns that this is no probe, and leaves a rapid move
    assert faults_of(job) == [("J141", "Probe", 0), ("J103", "Job", 0)]
    add_operation(job)
    add_operation(job, ["G0 Z50"], "as typed")
    program, faults = read_job(job)
    assert [(fault.code, fault.place.operation) for fault in faults] == [("J141", "Probe")]
    assert (program.kind != Kind.RAPID).any()


def test_faults_of_all_operations_are_reported_together(job):
    add_operation(job, [*FIVE_AXIS, "G86 X1"], "First")
    add_operation(job, ["G0 X0 Y0 Z0", "G1 X1"], "Second")
    assert faults_of(job) == [("J104", "First", 7), ("J105", "Second", 4)]


def test_another_direction_of_the_spindle_in_cams_own_path_is_refused(job):
    """FreeCAD 1.1 posts the direction of the tool bit, whatever the controller says."""
    operation, controller = add_operation(job), job.Tools.Group[0]
    turn(controller, "Reverse")
    job.Document.recompute()
    assert read_job(job)[1] == ()
    if int(App.Version()[1]) > 0:
        controller.SpindleDir = "Forward"
        job.Document.recompute()
    else:
        controller.Path = Path.Path("M6 T1\nM3 S9000")
        controller.purgeTouched()
        operation.purgeTouched()
    (fault,) = read_job(job)[1]
    assert fault.code == "J143" and fault.place.operation == controller.Label and "CAM's path" in fault.found
    controller.SpindleSpeed = 0
    job.Document.recompute()
    assert read_job(job)[1] == ()


def test_operation_without_tool_controller(job):
    add_operation(job).ToolController = None
    assert faults_of(job) == [("J112", "Cut", 0)]


@pytest.mark.parametrize("length", [0, 10_001])
def test_tool_of_unknown_or_impossible_gauge_length(job, length):
    add_operation(job)
    job.Tools.Group[0].GaugeLength = length
    assert faults_of(job) == [("J113", job.Tools.Group[0].Label, 0)]


def test_tool_controller_without_the_property(job):
    job.Tools.Group[0].removeProperty("GaugeLength")
    add_operation(job)
    assert faults_of(job) == [("J113", job.Tools.Group[0].Label, 0)]


def test_m6_for_a_tool_the_job_does_not_have(job):
    add_operation(job, [*FIVE_AXIS, "M6 T9"])
    assert faults_of(job) == [("J113", "Cut", 0)]


def test_the_spindle_starts_again_after_a_typed_tool_change(job):
    first, second = add_operation(job, [*ARC, "M6 T2"], "First"), add_operation(job, ARC, "Second")
    other = second.ToolController = add_tool_controller(job, 2)
    other.SpindleSpeed = first.ToolController.SpindleSpeed
    changed = [(TOOL, 1.0), (SPINDLE, 9000.0), (TOOL, 2.0), (SPINDLE, 9000.0), (SPINDLE, 0.0)]
    assert [(kind, value) for _, kind, value in events(program_of(job))] == changed


def test_two_tools_of_one_number(job):
    add_operation(job, label="First")
    other = add_tool_controller(job, 1)
    other.Tool.Diameter = 3
    add_operation(job, label="Second").ToolController = other
    assert faults_of(job) == [("J114", other.Label, 0)]


class _Fails:
    """A proxy that cannot compute its object."""

    def execute(self, obj):
        raise RuntimeError("cannot")


def test_operation_that_cannot_be_computed(job):
    add_operation(job)
    broken = job.Document.addObject("Path::FeaturePython", "Broken")
    broken.Proxy = _Fails()
    job.Proxy.addOperation(broken)
    job.Document.recompute()
    assert faults_of(job) == [("J116", "Broken", 0)]


NOTHING = "number or diameter of its tool is 0"


@pytest.mark.parametrize(
    ("found", "change"),
    [
        ("its job has no model", lambda job: [job.Document.removeObject(each.Name) for each in job.Model.Group]),
        ("its tool controller has no tool", lambda job: job.Document.removeObject(job.Tools.Group[0].Tool.Name)),
        (NOTHING, lambda job: setattr(job.Tools.Group[0], "ToolNumber", 0)),
        (NOTHING, lambda job: setattr(job.Tools.Group[0].Tool, "Diameter", 0)),
    ],
    ids=["model", "tool", "number", "diameter"],
)
def test_operation_that_cam_leaves_as_it_was_is_refused_with_its_copies(job, found, change):
    """CAM says in the Report view alone that it did not compute it; the earlier path is still there."""
    operation = add_operation(job)
    mirror = create_mirror(operation, App.Vector(1, 0, 0))
    assert len(program_of(job)) == 8
    operation.Gcode = ARC
    change(job)
    job.Document.recompute()
    assert operation.isValid() and len(moves(operation)) == len(FIVE_AXIS)
    program, faults = read_job(job)
    assert program is None
    refused = [(fault.code, fault.place.operation, fault.found) for fault in faults if fault.code == "J116"]
    assert refused == [("J116", each.Label, found) for each in (operation, mirror)]


@pytest.mark.parametrize("kind", ["Profile", "Custom"])
def test_job_on_a_model_that_fails_is_refused(document, kind):
    """FreeCAD leaves what depends on it as it was, and calls it up to date."""
    box, fillet = document.addObject("Part::Box", "Box"), document.addObject("Part::Fillet", "Fillet")
    box.Length, fillet.Base, fillet.Edges = 30, box, [(1, 1.0, 1.0)]
    document.recompute()
    job = Path.Main.Job.Create("Job", [fillet], None)
    controller = job.Tools.Group[0]
    set_gauge_length(controller, 120)
    controller.HorizFeed = controller.VertFeed = "10 mm/s"
    made = operation_on(job, "Profile", lambda box: box.ZMax < 0.01) if kind == "Profile" else add_operation(job)
    assert faults_of(job) == []
    box.Length, fillet.Edges = 60, [(1, 50.0, 50.0)]
    assert faults_of(job) == [("J116", made.Label if kind == "Profile" else job.Label, 0)]
    assert made.State == ["Up-to-date"] and job.Model.Group[0].Shape.BoundBox.XLength < 31
    fillet.Edges = [(1, 1.0, 1.0)]
    assert faults_of(job) == []


def test_copies_in_a_circle_are_refused(job):
    first = create_mirror(add_operation(job), App.Vector(1, 0, 0))
    second = create_mirror(first, App.Vector(0, 1, 0))
    job.Document.recompute()
    first.Base = second
    assert faults_of(job) == [("J116", each.Label, 0) for each in (first, second)]


def test_operation_called_for_by_m6_without_a_tool_is_refused(job):
    add_operation(job, [*FIVE_AXIS, "M6 T5"])
    other = add_tool_controller(job, 5)
    other.Tool = None
    assert [(code, place) for code, place, _ in faults_of(job)] == [("J112", other.Label)]


@pytest.mark.parametrize(("group", "expected"), [("Operations", ["J103"]), ("Tools", []), ("Model", ["J116"])])
def test_job_without_one_of_its_groups(job, group, expected):
    job.GeometryTolerance = 0.01
    add_operation(job)
    job.Document.removeObject(getattr(job, group).Name)
    job.Document.recompute()
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", "--machine example_6tps --work-offset=0,0,250"
    found = prepared_job(job, settings_of(job)).found
    assert [fault.code for fault in found if fault.severity.value == "error"] == expected


def test_long_tool_axis_is_a_warning(job):
    add_operation(job, ["G0 X0 Y0 Z9", "G1 X1 I0 J0 K2 F1"])
    assert faults_of(job) == [("J118", "Cut", 4)]


def without_tool_axes(commands):
    """What dress-ups that do not know of tool axes leave of moves: X Y Z F of lines, arcs as they are."""
    lines = "G0", "G1"
    kept = [{k: v for k, v in each.Parameters.items() if each.Name not in lines or k in "XYZF"} for each in commands]
    return Path.Path([Path.Command(each.Name, words) for each, words in zip(commands, kept, strict=True)])


class _DressUp:
    """Stands for a dress-up of CAM."""

    def execute(self, obj):
        obj.Path = without_tool_axes(obj.Base.Path.Commands)


def dress_up(base):
    layer = base.Document.addObject("Path::FeaturePython", "DressupOfOthers")
    layer.addProperty("App::PropertyLink", "Base")
    layer.Proxy, layer.Base = _DressUp(), base
    return layer


def put_in_place_of(base, layer, job):
    job.Proxy.addOperation(layer, base, True)
    job.Document.recompute()


def test_foreign_dress_up_above_tool_axes(job):
    base = add_operation(job)
    put_in_place_of(base, dress_up(base), job)
    program, faults = read_job(job)
    assert program is None
    assert [(fault.code, fault.found) for fault in faults] == [("J108", "DressupOfOthers")]


def test_foreign_dress_up_below_a_mirror_of_ours(job):
    base = add_operation(job)
    layer = dress_up(base)
    put_in_place_of(base, layer, job)
    layer.Label = "Ramp"
    create_mirror(layer, (0, 1, 0), label="Mirror")
    job.Document.recompute()
    assert faults_of(job) == [("J108", "Ramp", 0), ("J108", "Mirror", 0)]


def test_foreign_dress_up_without_tool_axes_is_welcome(job):
    base = add_operation(job, ARC)
    put_in_place_of(base, dress_up(base), job)
    program = program_of(job)
    assert program.operations == ("DressupOfOthers",)
    assert events(program)[0] == (0, TOOL, 1)  # inherited from the base


def test_array_of_others_with_a_list_of_bases(job):
    base = add_operation(job)
    array = job.Document.addObject("Path::FeaturePython", "Array")
    array.addProperty("App::PropertyLinkList", "Base")
    array.addProperty("App::PropertyLink", "ToolController")
    array.Proxy, array.Base, array.ToolController = _ArrayOfOne(), [base], base.ToolController
    put_in_place_of(base, array, job)
    assert faults_of(job) == [("J108", "Array", 0)]


class _ArrayOfOne:
    def execute(self, obj):
        obj.Path = without_tool_axes(obj.Base[0].Path.Commands)


def test_stock_profile_is_read(job):
    import Path.Op.Profile

    box = job.Model.Group[0]
    profile = Path.Op.Profile.Create("Profile", parentJob=job)
    profile.ToolController = job.Tools.Group[0]
    profile.ToolController.HorizFeed = profile.ToolController.VertFeed = "10 mm/s"
    profile.Base = [(box, ["Face6"])]
    job.Document.recompute()
    program = program_of(job)
    assert np.all(program.feed[program.kind > 0] == 10)
    assert {name for name, _ in moves(profile)} & {"G2", "G3"}
    low, high = program.position.min(axis=0), program.position.max(axis=0)
    np.testing.assert_allclose(high[:2] - low[:2], 20 + profile.ToolController.Tool.Diameter.Value, atol=1e-4)


def test_moves_that_would_go_on_at_the_feed_of_the_plunge_are_refused(document):
    job = job_on(document, Part.makeBox(30, 20, 10), "endmill.fcstd", Diameter=6)
    job.Tools.Group[0].HorizFeed = 0
    profile = operation_on(job, "Profile", lambda box: box.ZMax < 0.01)
    mirror = create_mirror(profile, App.Vector(1, 0, 0))
    assert faults_of(job) == [("J105", each.Label, 0) for each in (profile, mirror)]
    cuts = [words for name, words in moves(profile) if name in ("G1", "G2", "G3")]
    assert {words.get("F") for words in cuts} == {5.0, None}
    job.Tools.Group[0].HorizFeed = "10 mm/s"
    assert faults_of(job) == []


@pytest.mark.parametrize("order", ["Fixture", "Tool", "Operation"])
def test_order_of_output_does_not_matter(job, order):
    add_operation(job, label="First")
    job.OrderOutputBy = order
    assert program_of(job).operations == ("First",)
