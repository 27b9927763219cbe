# SPDX-License-Identifier: LGPL-2.1-or-later
"""What happens in a FreeCAD with a window: run by FreeCAD, writes what it found as JSON and ends.

The environment names the files, since FreeCAD would open those that its command line names: PKM_RESULT for the JSON,
PKM_SCREENSHOT for a picture of the window. Each step is a function; an exception in one is its result, and the others
still run.
"""

import json
import os
import sys
import time
import traceback
from pathlib import Path

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.abspath(__file__)))]
sys.path[:0] = [os.path.join(sys.path[0], "freecad_app")]

RESULT, SCREENSHOT = os.environ["PKM_RESULT"], os.environ["PKM_SCREENSHOT"]
FOLDER = os.path.dirname(SCREENSHOT)
STEPS = []


def step(function):
    STEPS.append(function)
    return function


def select(item):
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(item)


def settle():
    for _ in range(20):
        QtWidgets.QApplication.processEvents()


@step
def workbench_has_its_commands():
    FreeCADGui.activateWorkbench("PkmPostWorkbench")
    settle()
    window = FreeCADGui.getMainWindow()
    bars = [bar for bar in window.findChildren(QtWidgets.QToolBar) if bar.windowTitle() == "PKM Post"]
    actions = [action for bar in bars for action in bar.actions()]
    return {
        "listed": "PkmPostWorkbench" in FreeCADGui.listWorkbenches(),
        "buttons": [action.text() for action in actions],
        "icons": [not action.icon().isNull() for action in actions],
    }


@step
def job_is_made():
    from cam_jobs import add_operation, new_job

    document = FreeCAD.newDocument("gui")
    job = new_job(document)
    job.PostProcessor = "hexapod_pmac"
    job.PostProcessorArgs = "--work-offset=0,0,250"
    operation = add_operation(job)
    return {"job": job.Name, "operation": operation.Name}


@step
def commands_know_what_they_are_for():
    document = FreeCAD.getDocument("gui")
    job, operation = document.getObject("Job"), document.getObject("Custom")
    active = {}
    for name, item in (("job", job), ("operation", operation), ("controller", job.Tools.Group[0])):
        select(item)
        active[name] = [FreeCADGui.Command.get(f"PKM_{c}").isActive() for c in ("Mirror", "Rotate", "Post")]
    return active


@step
def mirror_and_rotate_from_their_buttons():
    document = FreeCAD.getDocument("gui")
    for command in ("PKM_Mirror", "PKM_Rotate"):
        select(document.getObject("Custom"))
        FreeCADGui.runCommand(command, 0)
        settle()
    made = document.getObject("Job").Operations.Group[1:]
    return {
        "labels": [item.Label for item in made],
        "views": [type(item.ViewObject.Proxy).__name__ for item in made],
        "icons": [os.path.basename(item.ViewObject.Proxy.getIcon()) for item in made],
        "moves": [len(item.Path.Commands) for item in made],
    }


@step
def undo_takes_one_step_back():
    document = FreeCAD.getDocument("gui")
    before = len(document.getObject("Job").Operations.Group)
    document.undo()
    document.recompute()
    return {"before": before, "after": len(document.getObject("Job").Operations.Group)}


@step
def normal_compensation_from_its_button():
    from cam_jobs import add_operation, new_job

    document = FreeCAD.newDocument("contacts")
    add_operation(new_job(document), ["G0 X5 Y5 Z40", "G1 Z20 F10", "G1 X15", "G0 Z40"])
    base = document.getObject("Custom")
    select(base)
    FreeCADGui.runCommand("PKM_NormalCompensation", 0)
    settle()
    (dressup,) = document.getObject("Job").Operations.Group
    view = dressup.ViewObject.Proxy
    made = {
        "view": type(view).__name__,
        "icon": os.path.basename(view.getIcon()),
        "children": [child.Name for child in view.claimChildren()],
        "moves": len([command for command in dressup.Path.Commands if command.Name in ("G0", "G1")]),
        "base_is_shown": base.ViewObject.Visibility,
    }
    document.removeObject(dressup.Name)
    made["given_back"] = [item.Name for item in document.getObject("Job").Operations.Group]
    made["base_is_shown_again"] = base.ViewObject.Visibility
    FreeCAD.closeDocument("contacts")
    FreeCAD.setActiveDocument("gui")
    return made


@step
def surface_finish_from_its_button():
    import Part
    import Path.Main.Gui.Job

    document = FreeCAD.newDocument("finish")
    stock = document.addObject("Part::Feature", "Block")
    stock.Shape = Part.makeBox(20, 20, 20)
    document.recompute()
    Path.Main.Gui.Job.Create([stock.Name], None, openTaskPanel=False)
    job = document.getObject("Job")
    controller = job.Tools.Group[0]
    controller.HorizFeed = controller.VertFeed = "600 mm/min"
    document.UndoMode = 1
    active = {}
    for name, item in (("job", job), ("face", stock), ("controller", controller)):
        select(item)
        active[name] = FreeCADGui.Command.get("PKM_SurfaceFinish").isActive()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(stock, "Face6")
    FreeCADGui.runCommand("PKM_SurfaceFinish", 0)
    settle()
    (operation,) = job.Operations.Group
    view = operation.ViewObject.Proxy
    told = {
        "active": active,
        "view": type(view).__name__,
        "icon": os.path.basename(view.getIcon()),
        "faces": [name for _, names in operation.Base for name in names],
        "valid": operation.isValid(),
        "panel_is_open": view.panel is not None,
    }
    told["stepover_shown"] = _change_stepover(view.panel, 2.0)
    view.panel.accept()
    document.recompute()
    told["accepted"], told["passes"] = operation.Stepover.Value, operation.PassCount
    operation.ViewObject.Document.setEdit(operation.ViewObject, 0)
    settle()
    _change_stepover(view.panel, 5.0)
    view.panel.reject()
    settle()
    told["rejected"], told["panel_is_left_open"] = operation.Stepover.Value, FreeCADGui.Control.activeDialog()
    while document.UndoCount and job.Operations.Group:
        document.undo()
    told["after_undo"] = len(job.Operations.Group)
    FreeCAD.closeDocument("finish")
    FreeCAD.setActiveDocument("gui")
    return told


def _change_stepover(panel, to):
    """What the page shows for the stepover, before it is set to another one."""
    page = panel.featurePages[-1]
    field = page.form.fields["Stepover"]
    shown = field.property("rawValue")
    field.setProperty("rawValue", to)
    page.pageGetFields()
    return shown


@step
def escape_stops_a_long_computation():
    from pkm_post.freecad_app.progress import Progress, Stopped

    class Patient:
        """Computes for as long as nobody presses Escape, a minute at most."""

        def execute(self, item):
            item.Label2 = ""
            try:
                with Progress("Waiting", 6000) as progress:
                    for number in range(6000):
                        if number == 20:
                            window, key = FreeCADGui.getMainWindow(), QtCore.Qt.Key.Key_Escape
                            pressed = QtCore.QEvent.Type.KeyPress, key, QtCore.Qt.KeyboardModifier.NoModifier
                            QtWidgets.QApplication.postEvent(window, QtGui.QKeyEvent(*pressed))
                        time.sleep(0.01)
                        progress.step()
            except Stopped as stopped:
                item.Label2 = f"{stopped}, step {number}"

    document = FreeCAD.newDocument("waiting")
    item = document.addObject("App::FeaturePython", "Patient")
    item.Proxy = Patient()
    document.recompute()
    inside = item.Label2
    item.Proxy.execute(item)
    told = {"inside a recompute": inside, "alone": item.Label2}
    FreeCAD.closeDocument("waiting")
    FreeCAD.setActiveDocument("gui")
    return told


@step
def machine_from_its_button():
    from cam_jobs import ARC, FIVE_AXIS, add_operation, new_job

    document = FreeCAD.newDocument("hexapod")
    job = new_job(document)
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", "--work-offset=0,0,250"
    add_operation(job, ARC, "Arcs")
    add_operation(job, FIVE_AXIS, "Tilted")
    document.UndoMode = 1
    FreeCADGui.Selection.clearSelection()
    alone = FreeCADGui.Command.get("PKM_Machine").isActive()
    select(job)
    FreeCADGui.runCommand("PKM_Machine", 0)
    settle()
    document.undo()
    undone = document.getObject("Machine") is None
    select(job)
    FreeCADGui.runCommand("PKM_Machine", 0)
    settle()
    machine = document.getObject("Machine")
    view, tops = machine.ViewObject.Proxy, []
    for height in (20, 120):
        machine.Tip = FreeCAD.Vector(0, 0, height)
        document.recompute()
        tops.append(_highest(view.scene._platform))
    told = {
        "alone": alone,
        "undone": undone,
        "job": machine.Job.Name,
        "icon": os.path.basename(view.getIcon()),
        "moved": tops[1] - tops[0],
        "out_of_limits": list(machine.OutOfLimits),
    }
    machine.Tip = FreeCAD.Vector(600, 0, -300)
    document.recompute()
    told["red"] = [tuple(strut._rod.diffuseColor[0].getValue()) for strut in view.scene._struts]
    machine.MachineFile = "no_such_machine"
    told["scene_without_machine"] = view.scene is not None
    machine.MachineFile, machine.Tip = "example_6tps", FreeCAD.Vector(0, 0, 60)
    document.recompute()
    told["scene"] = view.scene is not None
    return told


def _highest(transform):
    """The height of the platform in the machine, out of the scene graph."""
    return transform.matrix.getValue().getValue()[3][2]


@step
def reach_from_its_button():
    document = FreeCAD.getDocument("hexapod")
    select(document.getObject("Job"))
    FreeCADGui.runCommand("PKM_Reach", 0)
    settle()
    found = document.getObject("Reach")
    view = found.ViewObject.Proxy
    told = {"machine": found.Machine.Name, "reachable": found.Reachable, "nodes": view._root.getNumChildren()}
    view.doubleClicked(found.ViewObject)
    settle()
    (table,) = FreeCADGui.getMainWindow().findChildren(QtWidgets.QTableWidget, "PkmReachTable")
    row = list(found.Checks).index("base joints")
    table.cellClicked.emit(row, 0)
    settle()
    told |= {
        "rows": [table.item(line, 0).text() for line in range(table.rowCount())] == list(found.Checks),
        "colour_by": found.ColourBy,
        "selected": [item.Label for item in FreeCADGui.Selection.getSelection()] == [found.WorstOperations[row]],
    }
    found.Machine.ViewObject.Visibility = False
    told["saved"] = _picture("reach.png")
    found.Machine.ViewObject.Visibility = True
    FreeCADGui.getDocument("hexapod").resetEdit()
    settle()
    told["panel_is_left_open"] = bool(FreeCADGui.Control.activeDialog())
    document.undo()
    told["after_undo"] = found.ColourBy
    return told


@step
def simulation_from_its_button():
    document = FreeCAD.getDocument("hexapod")
    machine = document.getObject("Machine")
    before = machine.ViewObject.Proxy.scene._platform.matrix.getValue().getValue()
    select(document.getObject("Job"))
    FreeCADGui.runCommand("PKM_Simulate", 0)
    settle()
    player = _player()
    told = {"duration": player.simulation.duration, "told": player.told.text()}
    player.factor.setCurrentText("2x")
    player.toggle()
    until = time.monotonic() + 1.0
    while time.monotonic() < until:
        settle()
    player.toggle()
    told["played"] = player.seconds
    player.step()
    told["stepped"] = player.simulation.next_block(told["played"]) == player.seconds
    player.slider.setValue(4000)
    told["scrubbed"] = player.seconds
    tip = player.simulation.pose_at([4.0])[0][0]
    told["machine_is_there"] = bool(abs(tip[2] + 120 + 80 - _highest(machine.ViewObject.Proxy.scene._platform)) < 1.0)
    os.mkdir(f"{FOLDER}/frames")
    player.factor.setCurrentText("10x")
    player.write_pictures(Path(FOLDER) / "frames", per_second=2, width=320, height=240)
    told["pictures"] = sorted(os.listdir(f"{FOLDER}/frames"))
    document.getObject("Reach").ViewObject.Visibility = False
    told["saved"] = _picture("simulation.png")
    player.close()
    settle()
    after = machine.ViewObject.Proxy.scene._platform.matrix.getValue().getValue()
    told["machine_is_back"] = after == before
    select(document.getObject("Job"))
    FreeCADGui.runCommand("PKM_Simulate", 0)
    document.removeObject("Machine")
    settle()
    told["closed_with_its_machine"] = _player() is None
    document.getObject("Job").PostProcessorArgs = "--work-offset=500,0,200"
    select(document.getObject("Job"))
    FreeCADGui.runCommand("PKM_Simulate", 0)
    player = _player()
    player.advance(1e6)
    told["problem"], told["stopped_at"] = player.problem.text, player.seconds == player.problem.time
    FreeCAD.closeDocument("hexapod")
    settle()
    told["closed_with_its_document"] = _player() is None
    FreeCAD.setActiveDocument("gui")
    return told


def _picture(name):
    """Look at everything that is visible, from the corner, and keep a picture of the window."""
    FreeCADGui.activeView().viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    settle()
    return QtGui.QGuiApplication.primaryScreen().grabWindow(0).save(f"{FOLDER}/{name}")


def _player():
    return FreeCADGui.getMainWindow().findChild(QtWidgets.QDockWidget, "PkmPlayer")


def until(condition, seconds=20):
    """Let the window work until something is so; whether it is."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        QtWidgets.QApplication.processEvents()
        time.sleep(0.01)
    return condition()


PROGRAM = """G21 G90 G17
T1 M6
S9000 M3
G0 X0 Y0 Z30
G1 Z5 F600
G1 X10 Y4 F900
G2 X20 Y4 I5 J0
G0 Z30
M2
"""


def _editor():
    from pkm_post.freecad_gui.editor import open_editor

    return open_editor()


def _findings(editor):
    until(lambda: not editor.body.checker.busy())
    return [editor.body.findings.item(row).text() for row in range(editor.body.findings.count())]


@step
def program_is_opened_and_its_editor_shows_a_block():
    file = os.path.join(os.path.dirname(RESULT), "program.ngc")
    with open(file, "w", encoding="ascii") as stream:
        stream.write(PROGRAM)
    FreeCADGui.loadFile(file, "pkm_post.freecad_app.program_import")
    (obj,) = FreeCAD.ActiveDocument.Objects
    before = obj.ViewObject.RootNode.getNumChildren()
    select(obj)
    FreeCADGui.runCommand("PKM_Editor", 0)
    editor = _editor()
    findings = _findings(editor)
    editor.body.text.jump(7)
    FreeCADGui.SendMsgToActiveView("ViewFit")
    settle()
    drawn = obj.ViewObject.RootNode.getNumChildren() - before
    coloured = [block.layout().formats() for block, _ in editor.body.text.lines_in_sight()]
    picture = os.path.join(os.path.dirname(SCREENSHOT), "editor.png")
    QtGui.QGuiApplication.primaryScreen().grabWindow(0).save(picture)
    return {
        "moves": len([each for each in obj.Path.Commands if each.Name.startswith("G")]),
        "view": type(obj.ViewObject.Proxy).__name__,
        "title": editor.windowTitle(),
        "findings": findings,
        "size": editor.body.size.text(),
        "drawn": drawn,
        "coloured": sum(map(bool, coloured)),
        "points": editor.body._shown._places.point.getNum(),
    }


@step
def editor_finds_planted_errors_while_they_are_typed():
    editor = _editor()
    editor.body.text.replace_text(PROGRAM.replace("X10 Y4", "X1..5 Y4").replace("G0 Z30\nM2", "G0 Q\nM2"))
    findings = _findings(editor)
    underlined = [each.cursor.selectedText() for each in editor.body.text.extraSelections()[1:]]
    editor.body.findings.itemClicked.emit(editor.body.findings.item(1))
    jumped = editor.body.text.current_line()
    editor.body.text.undo()
    return {"findings": findings, "underlined": underlined, "jumped": jumped, "after_undo": _findings(editor)}


@step
def editor_replaces_renumbers_and_saves():
    (obj,) = FreeCAD.ActiveDocument.Objects
    editor = _editor()
    bar = editor.body.find_bar
    bar.begin()
    bar.wanted.setText("y4")
    found = [bar.find_next() and editor.body.text.current_line() for _ in range(3)]
    bar.instead.setText("Y8")
    replaced = bar.replace_all()
    editor.body.renumber()
    title = editor.windowTitle()
    saved = editor.save()
    with open(obj.File, encoding="ascii") as stream:
        text = stream.read()
    ys = sorted({each.Parameters["Y"] for each in obj.Path.Commands if "Y" in each.Parameters})
    bar.hide()
    return {"found": found, "replaced": replaced, "title": title, "saved": saved, "text": text, "ys": ys}


@step
def editor_colours_the_lines_in_sight_of_a_large_file():
    editor = _editor()
    before, large = editor.body.file, editor.body.file.with_name("large.apt")
    large.write_text("UNITS/MM\nFEDRAT/600,MMPM\n" + "GOTO/1,2,3\n" * 19998, encoding="ascii")
    editor.open_file(large)
    last = editor.body.text.document().findBlockByNumber(19999)
    until(lambda: editor.body.text.document().firstBlock().layout().formats())
    out_of_sight = len(last.layout().formats())
    editor.body.text.jump(20000)
    until(lambda: last.layout().formats())
    in_sight = len(last.layout().formats())
    until(lambda: not editor.body.checker.busy())
    told = {"out_of_sight": out_of_sight, "in_sight": in_sight, "size": editor.body.size.text()}
    told["back"] = editor.open_file(before)
    return told


@step
def editor_decodes_and_posts():
    editor, program = _editor(), FreeCAD.ActiveDocument
    FreeCAD.setActiveDocument("gui")
    before = len(FreeCAD.getDocument("gui").getObject("Job").Operations.Group)
    operation = editor.decode()
    told = [operation.Label, len(FreeCAD.getDocument("gui").getObject("Job").Operations.Group) - before]
    FreeCAD.getDocument("gui").undo()
    told.append(len(FreeCAD.getDocument("gui").getObject("Job").Operations.Group) - before)
    messages, ended = [], []
    editor.posting.ended.connect(lambda: ended.append(True))
    QtCore.QTimer.singleShot(0, lambda: _close_message(messages))
    editor.posting.post(editor.body.file, "none", "--work-offset=0,0,250 --tool-length 1=120")
    until(lambda: ended, 60)
    files = sorted(name for name in os.listdir(editor.body.file.parent) if name.startswith("program"))
    FreeCAD.closeDocument(program.Name)
    editor.hide()
    return {"decoded": told, "messages": messages, "files": files}


@step
def cam_menu_has_the_commands():
    FreeCADGui.activateWorkbench("CAMWorkbench")
    settle()
    texts = []
    for action in FreeCADGui.getMainWindow().menuBar().actions():
        if action.menu():
            texts += [item.text().replace("&", "") for item in _all_actions(action.menu())]
    return {"has": [text in texts for text in ("Mirror operation", "Rotate operation", "Post to a hexapod")]}


def _all_actions(menu):
    for action in menu.actions():
        yield action
        if action.menu():
            yield from _all_actions(action.menu())


@step
def post_command_writes_and_tells():
    document = FreeCAD.getDocument("gui")
    folder = os.path.dirname(RESULT)
    document.saveAs(os.path.join(folder, "gui.FCStd"))
    select(document.getObject("Job"))
    told = []
    QtCore.QTimer.singleShot(0, lambda: _close_message(told))
    FreeCADGui.runCommand("PKM_Post", 0)
    files = sorted(name for name in os.listdir(folder) if name.startswith("gui") and not name.endswith(".FCStd"))
    return {"files": files, "told": told}


@step
def refused_job_is_told_and_leaves_nothing():
    document = FreeCAD.getDocument("gui")
    folder = os.path.join(os.path.dirname(RESULT), "refused")
    os.mkdir(folder)
    document.saveAs(os.path.join(folder, "refused.FCStd"))
    for copy in document.getObject("Job").Operations.Group[1:]:
        document.removeObject(copy.Name)  # FreeCAD writes a traceback when a copy of a faulty operation is computed
    document.getObject("Custom").Gcode = ["G0 X0 Y0 Z30", "G1 X10 F0"]
    document.recompute()
    select(document.getObject("Job"))
    told = []
    QtCore.QTimer.singleShot(0, lambda: _close_message(told))
    FreeCADGui.runCommand("PKM_Post", 0)
    return {"files": [name for name in os.listdir(folder) if not name.endswith(".FCStd")], "told": told}


def _close_message(told):
    """Read the message box that is open and close it; come back while there is none."""
    box = QtWidgets.QApplication.activeModalWidget()
    if isinstance(box, QtWidgets.QMessageBox):
        told.append(box.text())
        box.accept()
    else:
        QtCore.QTimer.singleShot(50, lambda: _close_message(told))


@step
def report_view_has_no_traceback():
    views = [view for view in FreeCADGui.getMainWindow().findChildren(QtWidgets.QTextEdit) if _is_report(view)]
    told = "\n".join(view.toPlainText() for view in views)
    return {"views": len(views), "tracebacks": told.count("Traceback"), "end": told[-2000:]}


def _is_report(view):
    return view.metaObject().className() == "Gui::DockWnd::ReportOutput"


@step
def window_is_drawn():
    FreeCADGui.activateWorkbench("PkmPostWorkbench")
    FreeCADGui.SendMsgToActiveView("ViewFit")
    settle()
    return {"saved": QtGui.QGuiApplication.primaryScreen().grabWindow(0).save(SCREENSHOT)}


def main():
    results = {}
    for function in STEPS:
        try:
            results[function.__name__] = function()
        except Exception:
            results[function.__name__] = {"exception": traceback.format_exc()}
    with open(RESULT, "w", encoding="utf-8") as file:
        json.dump(results, file, indent=1)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)


QtCore.QTimer.singleShot(1500, main)
