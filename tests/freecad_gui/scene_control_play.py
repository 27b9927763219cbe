# SPDX-License-Identifier: LGPL-2.1-or-later
"""The player in the panel: a posted trajectory played on a simulated machine, held, slowed down, ended, aborted."""

from control_machine import connect_and_home, idle, messages, newest, posted_file, read_again, the_panel
from gui import click, main, picture, press, settle, step, until

SLOW = ("G1 X20 Y0 Z150 F1200", "X20 Y10", "X0 Y10", "X0 Y0")


def page():
    return the_panel().panel.play


def play_from(line=0):
    page().line.setValue(line)
    click(page().play)
    until(lambda: the_panel().console.play is not None)
    return the_panel().console.play


def ended():
    """Until nothing is played any more, and the panel shows that; what was said meanwhile."""
    until(lambda: the_panel().console.play is None, 120)
    settle()
    idle()
    return messages()[-1]


def phase(play):
    return "" if play.state is None else play.state.phase


def places():
    """Where the parts that a hand is at are, in the panel."""
    face = the_panel().panel
    parts = (page().override, page().go_on, page().single_block, face.stops.hold, face.stops.override)
    return [
        [part.mapTo(face, part.rect().topLeft()).x(), part.mapTo(face, part.rect().topLeft()).y()] for part in parts
    ]


@step
def a_posted_trajectory_is_opened():
    press("PKM_Control")
    connect_and_home()
    face, console = the_panel().panel, the_panel().console
    face.pages.setCurrentWidget(face.play)
    settle()
    found = {"before": [page().play.isEnabled(), page().play.toolTip().splitlines()[-1], page().name.text()]}
    program = posted_file("slow.ngc", *SLOW)
    page().read(program.with_suffix(".pmc"))
    until(lambda: not console.waits)
    settle()
    found["not a trajectory"] = [messages()[-1], page().play.isEnabled()]
    page().read(program.with_suffix(".pkmt"))
    until(lambda: console.has_trajectory)
    settle()
    until(lambda: page().play.isEnabled())
    return found | {"opened": page().name.text(), "end": page().end.isEnabled(), "on": page().go_on.isEnabled()}


@step
def it_is_played_slowed_held_and_resumed():
    face, before = the_panel().panel, places()
    page().override.setValue(30)
    play = play_from()
    until(lambda: phase(play) == "runs", 60)
    read_again()
    found = {"jog": face.jog.buttons["X", 1].isEnabled(), "reads": newest().status.running}
    until(lambda: page().place.text().startswith("runs"))
    found["said"] = [page().place.text(), page().speeds.toolTip(), face.stops.override.isEnabled()]
    click(face.stops.hold)
    until(lambda: phase(play) == "held" and newest().status.standing, 30)
    read_again()
    at = newest().pose.tip.tolist()
    found["held"] = [at == newest().pose.tip.tolist(), 0 < at[0] < 20, face.activity.text()]
    picture("play.png")
    click(face.stops.resume)
    until(lambda: phase(play) == "runs", 30)
    page().override.setValue(0)
    until(lambda: play.waits_for == "override 0", 60)
    until(lambda: page().place.text().startswith("waits: override 0"))
    found["override 0"] = [newest().status.running, page().go_on.isEnabled()]
    page().override.setValue(150)
    until(lambda: phase(play) == "runs", 60)
    found["stands"] = places() == before
    found["ended"] = ended()
    found["messages"] = messages()
    return found | {"tip": newest().pose.tip.tolist(), "play": until(lambda: page().play.isEnabled())}


@step
def single_block_rests_at_each_line_and_a_line_is_begun_at():
    page().single_block.setChecked(True)
    play = play_from(4)
    found = {"waits": []}
    until(lambda: play.waits_for.startswith("T"), 60)
    found["waits"].append(play.waits_for)
    for _ in range(2):
        until(lambda: page().go_on.isEnabled(), 60)
        before = play.waits_for
        click(page().go_on)
        until(lambda before=before: phase(play) == "runs" or play.waits_for != before, 60)
        until(lambda: play.waits_for == "single block", 90)
        found["waits"].append([play.state.line, [round(value, 3) for value in newest().pose.tip.tolist()]])
    page().single_block.setChecked(False)
    click(page().go_on)
    return found | {"ended": ended(), "tip": newest().pose.tip.tolist()}


@step
def a_line_that_is_not_there_is_refused_and_an_abort_ends_a_play():
    face = the_panel().panel
    page().line.setValue(99)
    click(page().play)
    settle()
    found = {"refused": messages()[-1], "plays": the_panel().console.play is not None}
    page().override.setValue(20)
    play = play_from()
    until(lambda: phase(play) == "runs", 60)
    click(face.stops.abort)
    before = len(messages())
    ended()
    found["ended"] = "\n".join(messages()[before:])
    until(face.jog.buttons["X", 1].isEnabled)
    found["running"] = [newest().status.running, face.jog.buttons["X", 1].isEnabled()]
    found["left"] = sum(abs(newest().pose.tip - [0, 0, 300]))
    return found


main()
