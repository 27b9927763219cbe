# SPDX-License-Identifier: LGPL-2.1-or-later
"""The player in the panel: a posted trajectory played on a simulated machine, held, slowed down, ended, aborted.

Blocks are skipped, the tool is retracted; offsets of the machine and solids in the way are taken into account.
"""

from control_machine import connect_and_home, idle, messages, newest, posted_file, read_again, the_panel
from gui import FOLDER, click, main, picture, press, settle, step, until
from meshes import box

SKIPPED = ("G1 X20 Y0 Z150 F1200", "/X20 Y10", "/X0 Y10", "X0 Y0")
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
    before = len(messages())
    until(lambda: the_panel().console.play is None)
    settle()
    idle()
    return "\n".join(messages()[before:])


def phase(play):
    return "" if play.state is None else play.state.phase


def is_held(play):
    """Held while it ran; a hold that finds it at rest, since a plan came late, waits instead."""
    return phase(play) == "held" or play.waits_for == "hold"


def places():
    """Where the parts that a hand is at are, in the panel."""
    face = the_panel().panel
    ours = (page().override, page().go_on, page().single_block, page().retract, page().skip, page().setup.length)
    parts = (*ours, face.progress, face.stops.hold, face.stops.override)
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
    until(lambda: phase(play) == "runs")
    read_again()
    found = {"jog": face.jog.buttons["X", 1].isEnabled(), "reads": newest().status.running}
    until(lambda: page().place.text().startswith("runs"))
    found["said"] = [page().place.text(), page().speeds.toolTip(), face.stops.override.isEnabled()]
    found["in sight"] = [face.progress.toolTip(), face.progress.height() <= 2 * face.progress.fontMetrics().height()]
    grey = (
        page().retract,
        page().retract_distance,
        page().line,
        page().repeat_codes,
        page().skip.box,
        page().skip.file.choose,
        page().setup.shift["X"],
        page().setup.tool,
    )
    found["grey"] = [part.toolTip().splitlines()[-1] for part in grey if not part.isEnabled()]
    click(face.stops.hold)
    until(lambda: is_held(play) and newest().status.standing)
    read_again()
    at = newest().pose.tip.tolist()
    read_again()
    found["held"] = [at == newest().pose.tip.tolist(), 0 < at[0] < 20]
    found["activity"] = [newest().status.held, face.activity.text()]
    picture("play.png")
    click(face.stops.resume)
    until(lambda: phase(play) == "runs")
    page().override.setValue(0)
    until(lambda: play.waits_for == "override 0")
    until(lambda: page().place.text().startswith("waits: override 0"))
    found["override 0"] = [newest().status.running, page().go_on.isEnabled()]
    page().override.setValue(150)
    until(lambda: phase(play) == "runs")
    found["stands"] = places() == before
    found["ended"] = ended()
    found["messages"] = messages()
    return found | {"tip": newest().pose.tip.tolist(), "play": until(lambda: page().play.isEnabled())}


@step
def single_block_rests_at_each_line_and_a_line_is_begun_at():
    page().single_block.setChecked(True)
    play = play_from(4)
    found = {"waits": []}
    until(lambda: play.waits_for.startswith("T"))
    found["waits"].append(play.waits_for)
    for _ in range(2):
        until(lambda: page().go_on.isEnabled())
        before = play.waits_for
        click(page().go_on)
        until(lambda before=before: phase(play) == "runs" or play.waits_for != before)
        until(lambda: play.waits_for == "single block")
        found["waits"].append([play.state.line, [round(value, 3) for value in newest().pose.tip.tolist()]])
    page().single_block.setChecked(False)
    click(page().go_on)
    return found | {"ended": ended(), "tip": newest().pose.tip.tolist()}


@step
def the_tool_is_retracted_and_comes_back():
    page().override.setValue(30)
    play = play_from()
    until(lambda: phase(play) == "runs")
    page().override.setValue(0)
    until(lambda: play.waits_for == "override 0")
    until(page().retract.isEnabled)
    before = newest().pose.tip.tolist()
    page().retract_distance.setProperty("rawValue", 15.0)
    click(page().retract)
    until(lambda: newest().pose.tip[2] > before[2] + 14.999)
    until(lambda: "above its path" in messages()[-1])
    found = {"up": (newest().pose.tip - before).tolist(), "said": messages()[-1]}
    page().retract_distance.setProperty("rawValue", 5000.0)
    click(page().retract)
    until(lambda: "no retract" in messages()[-1])
    found["refused"] = messages()[-1]
    page().override.setValue(150)
    return found | {"ended": ended(), "tip": newest().pose.tip.tolist()}


@step
def blocks_behind_a_slash_are_skipped():
    from pkm_post.model import Tool
    from pkm_post.reading import ReadingOptions

    ball = {0: Tool(0, "ball", 12.0, 6.0, 120.0)}
    console, skip = the_panel().console, page().skip
    whole, without = (
        posted_file(f"{name}.ngc", *SKIPPED, reading=ReadingOptions(tools=ball, block_delete=deletes)).with_suffix(
            ".pkmt"
        )
        for name, deletes in (("whole", False), ("without", True))
    )
    page().read(whole)
    until(lambda: not console.waits)
    settle()
    found = {"before": [skip.box.isEnabled(), skip.box.toolTip().splitlines()[-1]], "lines": []}
    skip.file.take((str(whole.with_suffix(".pmc")),))
    until(lambda: not console.waits)
    found["not a trajectory"] = [messages()[-1], skip.file.files, skip.without is None]
    skip.file.take((str(without),))
    until(lambda: skip.without is not None and skip.box.isEnabled())
    for skips in (True, False):
        skip.box.setChecked(skips)
        play, lines = play_from(), set()
        until(lambda play=play, lines=lines: play.state and lines.add(play.state.line) or play.done.done())
        found["lines"].append([sorted(lines), ended()])
    return found


@step
def a_stop_while_it_is_prepared_comes_first():
    face, before = the_panel().panel, len(messages())
    page().line.setValue(0)
    click(page().play)
    face.stops.hold.click()
    until(lambda: any("a stop came first" in text for text in messages()[before:]))
    return {"plays": the_panel().console.play is not None}


@step
def a_line_that_is_not_there_is_refused_and_an_abort_ends_a_play():
    face = the_panel().panel
    page().repeat_codes.setChecked(True)
    repeats = page()._choices(1).repeat_codes
    page().repeat_codes.setChecked(False)
    page().line.setValue(99)
    click(page().play)
    settle()
    found = {"refused": messages()[-1], "plays": the_panel().console.play is not None}
    found["repeats"] = [repeats, page()._choices(1).repeat_codes]
    page().override.setValue(20)
    play = play_from()
    until(lambda: phase(play) == "runs")
    click(face.stops.abort)
    found["ended"] = ended()
    until(face.jog.buttons["X", 1].isEnabled)
    found["running"] = [newest().status.running, face.jog.buttons["X", 1].isEnabled()]
    found["left"] = sum(abs(newest().pose.tip - [0, 0, 300]))
    page().override.setValue(100)
    return found


@step
def a_dry_run_without_a_feed_is_refused():
    found = []
    page().dry_run.setChecked(True)
    for feed in (0.0, -3.0):
        before = len(messages())
        page().dry_feed.setProperty("rawValue", feed)
        click(page().play)
        settle()
        found.append([messages()[before:], the_panel().console.play is None and not the_panel().console.waits])
    page().dry_run.setChecked(False)
    return {"refused": found}


@step
def offsets_of_the_machine_are_those_of_the_play():
    setup = page().setup
    page().approach.setChecked(True)
    setup.shift["X"].setProperty("rawValue", 2.0)
    setup.shift["Y"].setProperty("rawValue", -3.0)
    found = {"tools": [setup.tool.itemText(row) for row in range(setup.tool.count())]}
    found["length"] = setup.length.length()
    setup.length.setText("110 mm")
    setup.length.editingFinished.emit()
    play = play_from()
    until(lambda: play.waits_for.startswith("T"))
    found["waits"] = play.waits_for
    until(page().go_on.isEnabled)
    click(page().go_on)
    found["ended"] = ended()
    page().approach.setChecked(False)
    setup.take(page()._opened[0])
    # the tool at hand is 120 mm long for the panel, but 110 mm for the play
    return found | {"tip": newest().pose.tip.tolist(), "reset": [str(setup.offsets()), setup.offsets().is_empty]}


@step
def a_clamp_on_the_way_to_a_line_is_refused():
    clamp, tip = FOLDER / "clamp.stl", newest().pose.tip
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x:g} {y:g} {z:g}\n" for x, y, z in triangle)
        + "endloop\nendfacet\n"
        for triangle in box([-15, 4, 100], [15, 7, 200])
    )
    clamp.write_text(f"solid clamp\n{facets}endsolid clamp\n", encoding="ascii")
    page().setup.solids["fixtures"].take((str(clamp),))
    found = {"shown": page().setup.solids["fixtures"]._name.text()}
    play = play_from(5)
    until(lambda: play.waits_for.startswith("T"))
    click(page().go_on)
    found["refused"] = ended()
    found["stands"] = abs(newest().pose.tip - tip).max()
    page().setup.solids["fixtures"].take((str(FOLDER / "no.stl"),))
    before = len(messages())
    click(page().play)
    until(lambda: len(messages()) > before)
    settle()
    found["no file"] = [messages()[-1], the_panel().console.play is None]
    page().setup.solids["fixtures"].take(())
    return found


main()
