# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool, spindle and coolant at each stop and dwell of a job are those of CAM's own post for LinuxCNC."""

import re

import Path
import pytest
from cam_jobs import FIVE_AXIS, add_operation, add_tool_controller
from Path.Post.Processor import PostProcessorFactory

from pkm_post.freecad_app.job import read_job
from pkm_post.model import EventKind

COOLANT = {"M7": 2, "M8": 1, "M9": 0}


def stop(job, code="M0", before=None):
    """What CAM's Stop makes; its own function needs a window. FreeCAD 1.0 makes no operation behind it."""
    made = job.Document.addObject("Path::Feature", "Stop")
    made.Path = Path.Path([Path.Command(code)])
    job.Proxy.addOperation(made, before)


def states_of_cam(job):
    """(code, tool, spindle speed, coolant) at each stop and dwell in the text of CAM's post."""
    job.PostProcessor, job.PostProcessorArgs = "linuxcnc", "--no-header --no-comments --no-show-editor"
    ((_, text),) = PostProcessorFactory.get_post_processor(job, "linuxcnc").export()
    tool, speed, coolant, found = 0, 0, 0, []
    for code, number in re.findall(r"(?m)^(M\d+|G4)\b *(?:[TSP]([\d.]+))?", text):
        if code == "M6":
            tool, speed = int(number), 0
        elif code in ("M3", "M5", "M05"):
            speed = int(number or 0)
        elif code in COOLANT:
            coolant = COOLANT[code]
        elif code in ("M0", "M1", "G4"):
            found.append((code, tool, speed, coolant))
    return found


def states_read(job):
    """The same of the program of the job."""
    program, _ = read_job(job)
    state, found = {}, []
    for event in program.events:
        if event.kind in (EventKind.STOP, EventKind.DWELL):
            code = "G4" if event.kind is EventKind.DWELL else f"M{event.value:.0f}"
            kinds = EventKind.TOOL_CHANGE, EventKind.SPINDLE, EventKind.COOLANT
            found.append((code, *(state.get(kind, 0) for kind in kinds)))
        state[event.kind] = event.value
    return found


def cut(job, label, coolant="None", controller=None, lines=FIVE_AXIS):
    operation = add_operation(job, lines, label)
    operation.CoolantMode, operation.ToolController = coolant, controller or job.Tools.Group[0]
    return operation


def a_stop_between_two_with_coolant(job):
    cut(job, "First", "Flood")
    stop(job, before=cut(job, "Second", "Flood"))
    stop(job, "M1")


def a_stop_after_typed_coolant(job):
    cut(job, "First", "Flood")
    cut(job, "Typed", lines=["M8"])
    stop(job, before=cut(job, "Second"))


def a_spindle_that_warms_up(job):
    cut(job, "Warm up", lines=["G4 P30"])
    cut(job, "First", "Flood")
    cut(job, "Rest", lines=["G4 P2"])
    cut(job, "Rinse", "Mist", lines=["G4 P3"])


def a_stop_with_the_next_tool(job):
    cut(job, "First", "Flood")
    other = add_tool_controller(job, 7)
    cut(job, "Measure", controller=other, lines=["M0"])
    cut(job, "Second", "Mist", controller=other)


CASES = {
    a_stop_between_two_with_coolant: [("M0", 1, 9000, 0), ("M1", 1, 9000, 0)],
    a_stop_after_typed_coolant: [("M0", 1, 9000, 1)],
    a_spindle_that_warms_up: [("G4", 1, 9000, 0), ("G4", 1, 9000, 0), ("G4", 1, 9000, 2)],
    a_stop_with_the_next_tool: [("M0", 7, 5000, 0)],
}


@pytest.mark.parametrize(("build", "expected"), CASES.items(), ids=lambda item: getattr(item, "__name__", ""))
def test_states_at_stops_and_dwells(job, build, expected):
    build(job)
    job.Document.recompute()
    assert states_of_cam(job) == expected
    assert states_read(job) == expected
