# SPDX-License-Identifier: LGPL-2.1-or-later
"""Habits: shortcuts and status tips of the commands, and the menus of the objects in the tree."""

import FreeCAD
import FreeCADGui
import Part
from gui import FOLDER, answer, click_named, job_on, main, new_document, press, select, settle, simulate, step, until
from PySide import QtWidgets

PROGRAM = "G21 G90 G17\nT1 M6\nG0 X0 Y0 Z30\nG1 Z5 F600\nG1 X10 F900\nM2\n"


def _menu(obj):
    """The menu as FreeCAD asks for it, and its entries by their texts."""
    menu = QtWidgets.QMenu(FreeCADGui.getMainWindow())
    obj.ViewObject.Proxy.setupContextMenu(obj.ViewObject, menu)
    return menu, {action.text(): action for action in menu.actions()}


def _texts(obj):
    return list(_menu(obj)[1])


def _choose(obj, text):
    menu, entries = _menu(obj)
    entries[text].trigger()
    settle()
    menu.deleteLater()


@step
def commands_have_tips_and_keys():
    FreeCADGui.activateWorkbench("PkmPostWorkbench")
    settle()
    names = [name for name in FreeCADGui.listCommands() if name.startswith("PKM_")]
    taken = {
        FreeCADGui.Command.get(name).getShortcut().replace(" ", "")
        for name in FreeCADGui.listCommands()
        if not name.startswith("PKM_")
    }
    found = {}
    for name in names:
        info = FreeCADGui.Command.get(name).getInfo()
        found[name] = {
            "keys": FreeCADGui.Command.get(name).getShortcut().replace(" ", ""),
            "tip": info["toolTip"],
            "status": info["statusTip"],
        }
    return {"commands": found, "others": sorted(taken)}


@step
def operations_have_menus():
    from pkm_post.freecad_app.normal_compensation import create_normal_compensation
    from pkm_post.freecad_app.surface_finish import create_surface_finish
    from pkm_post.freecad_app.symmetry import create_mirror, create_rotation
    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    document = new_document("operations")
    job, base = document.getObject("Job"), document.getObject("Custom")
    made = {
        "mirror": create_mirror(base, normal=(0, 1, 0)),
        "rotation": create_rotation(base, axis=(0, 0, 1), angle=1.0),
        "finish": create_surface_finish(job, []),
    }
    made["compensation"] = create_normal_compensation(base)
    made["finish"].Active = made["compensation"].Active = False  # no faces are chosen for them
    reported = {name: _texts(obj) for name, obj in made.items()}
    _choose(made["mirror"], "Edit")
    reported["edited"] = SymmetryPanel.opened.obj.Name == made["mirror"].Name
    SymmetryPanel.opened.reject()
    settle()
    return reported


@step
def menu_switches_an_operation_off():
    from pkm_post.freecad_app.symmetry import create_mirror

    document = new_document("switch")
    mirror = create_mirror(document.getObject("Custom"), normal=(0, 1, 0))
    document.recompute()
    seen = [(mirror.Active, _menu(mirror)[1]["Active"].isChecked(), len(mirror.Path.Commands))]
    _choose(mirror, "Active")
    seen.append((mirror.Active, _menu(mirror)[1]["Active"].isChecked(), len(mirror.Path.Commands)))
    document.undo()
    document.recompute()
    seen.append((mirror.Active, _menu(mirror)[1]["Active"].isChecked(), len(mirror.Path.Commands)))
    return seen


@step
def objects_of_a_job_have_menus():
    from pkm_post.freecad_app.machine_object import create_machine
    from pkm_post.freecad_app.reach_object import create_reach
    from pkm_post.freecad_app.simulation_object import create_simulation

    document = new_document("job")
    job = document.getObject("Job")
    machine = create_machine(document, job=job)
    reach, simulation = create_reach(job, machine), create_simulation(job, machine)
    document.recompute()
    reported = {"machine": _texts(machine), "reach": _texts(reach), "simulation": _texts(simulation)}
    reported["alone"] = _texts(create_machine(document))
    _choose(reach, "Open the findings")
    reported["findings"] = FreeCADGui.Control.activeDialog() is not False
    FreeCADGui.getDocument("job").resetEdit()
    settle()
    _choose(reach, "Simulate")
    reported["plays"] = [dock.subject.Name for dock in _docks("PkmPlayer")]
    for dock in _docks("PkmPlayer"):
        dock.close()
    settle()
    return reported


def _docks(name):
    return FreeCADGui.getMainWindow().findChildren(QtWidgets.QDockWidget, name)


@step
def machine_is_moved_home():
    machine = FreeCAD.getDocument("job").getObject("Machine")
    home, document = FreeCAD.Vector(machine.Tip), machine.Document
    machine.Tip, machine.Spin = home + FreeCAD.Vector(10, 20, 5), 7.0
    document.recompute()
    _choose(machine, "Move it home")
    moved = [(machine.Tip - home).Length, machine.Spin.Value]
    document.undo()
    return {"moved": moved, "undone": [(machine.Tip - home).Length, machine.Spin.Value]}


@step
def program_has_a_menu():
    from pkm_post.freecad_app.program_object import create_program

    document = new_document("program")
    file = FOLDER / "program.ngc"
    file.write_text(PROGRAM, encoding="ascii")
    part = create_program(document, str(file))
    document.recompute()
    reported = {"texts": _texts(part), "before": len(document.getObject("Job").Operations.Group)}
    _choose(part, "Open in the editor")
    reported["opened"] = [dock.widget.file.name for dock in _docks("PKM_Editor")]
    _choose(part, "Decode into a job")
    reported["after"] = len(document.getObject("Job").Operations.Group)
    return reported


@step
def command_of_a_menu_takes_its_object():
    document = new_document("other")
    from pkm_post.freecad_app.symmetry import create_rotation
    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    rotation = create_rotation(document.getObject("Custom"), axis=(0, 0, 1), angle=1.0)
    document.recompute()
    FreeCADGui.Selection.clearSelection()
    _choose(rotation, "Mirror operation")
    made = SymmetryPanel.opened.obj
    reported = {"base": made.Base.Name, "rotation": rotation.Name}
    SymmetryPanel.opened.accept()
    settle()
    return reported


def _state(document):
    """Whether a panel is open, an object is edited and a transaction is pending."""
    editing = FreeCADGui.getDocument(document.Name).getInEdit() is not None
    return [bool(FreeCADGui.Control.activeDialog()), editing, document.HasPendingTransaction]


def _closed_by_a_command(item, change):
    """The states of the document with the panel of an object and a change, and when a command has closed it."""
    item.ViewObject.Document.setEdit(item.ViewObject, 0)
    change()
    settle()
    before = _state(item.Document)
    FreeCADGui.Control.closeDialog()
    settle()
    after = _state(item.Document)
    select(item.Document.getObject("Stock"), "Face1")  # a traceback of what still follows would fail the scene
    item.Document.recompute()
    settle()
    return [before, after, item.Document.UndoNames[0]]


@step
def panels_are_closed_by_a_command():
    from pkm_post.freecad_app.machine_object import create_machine
    from pkm_post.freecad_app.reach_object import create_reach
    from pkm_post.freecad_app.symmetry import create_mirror

    document = new_document("closed")
    job = document.getObject("Job")
    machine, mirror = create_machine(document, job=job), create_mirror(document.getObject("Custom"), normal=(0, 1, 0))
    reach = create_reach(job, machine)
    document.recompute()
    found = {
        "mirror": _closed_by_a_command(mirror, lambda: setattr(mirror, "KeepClimb", True)),
        "machine": _closed_by_a_command(machine, lambda: setattr(machine, "Spin", 3.0)),
        "reach": _closed_by_a_command(reach, lambda: reach.ViewObject.Proxy._panel.show_worst(0)),
    }
    found["at its own pose"] = machine.ViewObject.Proxy.mover is None
    return found


@step
def surface_finish_is_closed_by_a_command():
    import Path.Main.Gui.Job
    import Path.Op.Gui.Selection

    from pkm_post.freecad_app.surface_finish import create_surface_finish

    document = FreeCAD.newDocument("finish")
    block = document.addObject("Part::Box", "Block")
    document.recompute()
    Path.Main.Gui.Job.Create([block.Name], None, openTaskPanel=False)
    finish = create_surface_finish(document.getObject("Job"), [])
    finish.ViewObject.Document.setEdit(finish.ViewObject, 0)
    settle()
    panel = finish.ViewObject.Proxy.panel
    found = {"open": bool(FreeCADGui.Control.activeDialog())}
    FreeCADGui.Selection.removeObserver(panel)  # CAM leaves it, and the gate of its selection, with each operation
    FreeCADGui.Control.closeDialog()
    Path.Op.Gui.Selection.clear()
    settle()
    document.recompute()  # a traceback of the page, which followed that, would fail the scene
    finish.ViewObject.Proxy.clearTaskPanel()
    FreeCADGui.getDocument(document.Name).resetEdit()
    return found


@step
def panels_of_a_job_leave_no_transaction():
    document, found = new_document("steps"), {}
    for command in ("PKM_Post", "PKM_Stiffness"):
        press(command, document.getObject("Job"))
        found[command] = [bool(FreeCADGui.Control.activeDialog()), FreeCAD.getActiveTransaction() is None]
        FreeCADGui.Control.closeDialog()
        settle()
    return found


def _is_enabled(command):
    return FreeCADGui.Command.get(command).getAction()[0].isEnabled()


@step
def windows_open_beside_a_panel():
    press("PKM_Post", new_document("beside").getObject("Job"))
    until(lambda: not _is_enabled("PKM_Machine"))  # FreeCAD looks at them all at once
    found = {name: _is_enabled(name) for name in ("PKM_Editor", "PKM_Control", "PKM_Example")}
    FreeCADGui.Control.closeDialog()
    settle()
    FreeCAD.closeDocument("beside")
    return found


@step
def an_undo_leaves_a_panel_a_step_of_its_own():
    """What is changed after an undo is one undo step again, and Cancel reverts it; the fields show what was undone."""
    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    document, found = new_document("undone"), {}
    press("PKM_Rotate", document.getObject("Custom"))
    SymmetryPanel.opened.accept()
    until(lambda: not FreeCADGui.Control.activeDialog())
    copy, names = document.getObject("Job").Operations.Group[-1], list(document.UndoNames)
    copy.ViewObject.Proxy.doubleClicked(copy.ViewObject)
    panel = SymmetryPanel.opened
    panel.copies.setValue(3)
    press("Std_Undo")
    found["fields"] = [copy.Copies, panel.copies.value(), FreeCADGui.Control.activeDialog()]
    panel.copies.setValue(2)
    panel.reject()
    settle()
    found["cancelled"] = [copy.Copies, list(document.UndoNames) == names]
    press("PKM_Machine", document.getObject("Job"))
    machine = document.getObject("Machine")
    before = list(machine.Tip)
    machine.ViewObject.Proxy.doubleClicked(machine.ViewObject)
    jog = machine.ViewObject.Proxy._panel
    jog.step(0, 1.0)
    press("Std_Undo")
    jog.step(1, 1.0)
    found["jog"] = [list(machine.Tip)[0] == before[0], document.UndoNames[0]]
    jog.reject()
    settle()
    found["jog cancelled"] = list(machine.Tip) == before
    machine.ViewObject.Proxy.doubleClicked(machine.ViewObject)
    press("Std_Undo")
    until(lambda: FreeCAD.getActiveTransaction() is None)
    found["deleted"] = [document.getObject("Machine") is None, FreeCADGui.Control.activeDialog()]
    FreeCAD.closeDocument("undone")
    return found


@step
def a_command_leaves_a_panel_a_step_of_its_own():
    """Delete does nothing to an object whose panel is open, but ends the transaction, as each command does."""
    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    document, found = new_document("between"), {}
    press("PKM_Mirror", document.getObject("Custom"))
    panel, mirror = SymmetryPanel.opened, SymmetryPanel.opened.obj
    press("Std_Delete", mirror)
    until(lambda: FreeCAD.getActiveTransaction() is not None)
    before = mirror.KeepClimb
    panel.keep_climb.setChecked(not before)
    found["changed"] = mirror.KeepClimb != before
    panel.reject()
    settle()
    found["cancelled"] = [mirror.KeepClimb == before, _state(document)]
    press("PKM_Machine", document.getObject("Job"))
    machine = document.getObject("Machine")
    machine.ViewObject.Proxy.doubleClicked(machine.ViewObject)
    jog = machine.ViewObject.Proxy._panel
    press("PKM_Reach", document.getObject("Job"))
    until(lambda: FreeCAD.getActiveTransaction() is not None)
    jog.step(0, 1.0)
    jog.accept()
    settle()
    found["jog"] = [list(document.UndoNames[:3]), _state(document)]
    FreeCAD.closeDocument("between")
    return found


def _is_in_front(name):
    return FreeCADGui.getMainWindow().getActiveWindow() == FreeCADGui.getDocument(name).activeView()


def _bring_to_front(name):
    """FreeCAD 1.1 may activate a new view late: wait until this one stays in front."""

    def stays():
        FreeCADGui.setActiveDocument(name)
        settle()
        return _is_in_front(name) and FreeCAD.ActiveDocument.Name == name

    until(stays)


@step
def simulate_in_the_panel_of_another_document():
    of_panel, active = new_document("of_panel"), new_document("active")
    _bring_to_front("of_panel")
    press("PKM_Post", of_panel.getObject("Job"))
    _bring_to_front("active")
    click_named("Simulate")
    until(lambda: _docks("PkmPlayer"))
    found = [document.getObject("Simulation") is not None for document in (of_panel, active)]
    in_front = _is_in_front("of_panel")
    for dock in _docks("PkmPlayer"):
        dock.close()
    FreeCADGui.Control.closeDialog()
    settle()
    for document in (of_panel, active):
        FreeCAD.closeDocument(document.Name)
    return {"simulated": found, "in front": in_front}


@step
def player_beside_a_panel_that_shows_a_finding():
    """Whichever was first, the player moves the machine, also when the panel has closed."""
    document = new_document("findings")
    job = document.getObject("Job")
    press("PKM_Machine", job)
    press("PKM_Reach", job)
    machine, reach = document.getObject("Machine").ViewObject.Proxy, document.getObject("Reach").ViewObject

    def pose():
        return machine.scene._platform.matrix.getValue().getValue()

    def moves():
        (player,) = _docks("PkmPlayer")
        player.go_to(0.0)
        begins = pose()
        player.go_to(player.simulation.duration / 2)
        return pose() != begins

    found = {}
    for first in ("panel", "player"):
        if first == "player":
            simulate(job)
        reach.Proxy.doubleClicked(reach)
        reach.Proxy._panel.show_worst(0)
        if first == "panel":
            found["posed"] = machine.mover is not None
            simulate(job)
        reach.Proxy._panel.reject()
        settle()
        found[first] = moves()
        for dock in _docks("PkmPlayer"):
            dock.close()
        settle()
        found[f"{first} closed"] = machine.mover is None
    FreeCAD.closeDocument("findings")
    return found


@step
def arguments_beside_a_mistake_are_kept():
    from pkm_post.freecad_gui.job_choices import JobChoices
    from pkm_post.model import Refused

    job = new_document("mistake").getObject("Job")
    job.PostProcessorArgs, found = "--work-offset=0,0,25O --surface-speed=100", {}
    choices = JobChoices(job)
    try:
        choices.keep()
    except Refused as refused:
        found["refused"] = [each.code for each in refused.diagnostics]
    choices.arguments.more.setText(choices.arguments.more.text().replace("25O", "250"))
    found["kept"] = list(choices.keep().work_offset[:3])
    found["fields"] = [choices.arguments.work_offset.currentText(), choices.arguments.more.text()]
    found["job"] = "--work-offset=0,0,250" in job.PostProcessorArgs
    choices.end()
    return found


@step
def mirror_beside_an_open_panel():
    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    document = new_document("beside")
    job, base, said = document.getObject("Job"), document.getObject("Custom"), []
    press("PKM_Post", job)
    before = len(document.Objects)
    answer(said)
    press("PKM_Mirror", base)
    found = {"said": said, "made": len(document.Objects) - before, "state": _state(document)}
    FreeCADGui.Control.closeDialog()
    settle()
    press("PKM_Mirror", base)
    first = SymmetryPanel.opened.obj.Name
    SymmetryPanel.opened.form.destroyed.connect(lambda *_: FreeCADGui.Selection.clearSelection())
    press("PKM_Mirror", base)  # with the panel of the first open
    second = SymmetryPanel.opened.obj.Name
    SymmetryPanel.opened.reject()
    settle()
    return found | {"left": [document.getObject(name) is not None for name in (first, second)]}


@step
def commands_draw_while_a_sheet_is_active():
    document = new_document("sheet")
    job, sheet = document.getObject("Job"), document.addObject("Spreadsheet::Sheet", "Sheet")
    drawn = FreeCADGui.getDocument("sheet").activeView().getSceneGraph()
    FreeCADGui.getDocument("sheet").setEdit(sheet.ViewObject, 0)
    settle()
    area = FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea)
    (shown,) = [each for each in area.subWindowList() if "SheetView" in each.widget().metaObject().className()]
    area.setActiveSubWindow(shown)
    settle()
    found = {"3D": hasattr(FreeCADGui.getDocument("sheet").activeView(), "getSceneGraph")}
    before = drawn.getNumChildren()
    press("PKM_Stiffness", job)
    found["stiffness"] = drawn.getNumChildren() - before
    FreeCADGui.Control.closeDialog()
    settle()
    found["closed"] = drawn.getNumChildren() - before
    simulate(job)
    found["simulation"] = drawn.getNumChildren() > before
    for dock in _docks("PkmPlayer"):
        dock.close()
    settle()
    found["left"] = drawn.getNumChildren() - before
    return found


@step
def finish_of_a_macro_is_opened():
    from pkm_post.freecad_app.surface_finish import create_surface_finish

    _, job = job_on("macro", Part.makeBox(20, 20, 5), "600 mm/min")
    document = job.Document
    made = create_surface_finish(job, [(job.Model.Group[0], ["Face6"])])
    made.Active = False
    document.recompute()
    FreeCADGui.getDocument("macro").setEdit(made.ViewObject, 0)
    settle()
    faces = [list(names) for _, names in made.Base]
    FreeCADGui.getDocument("macro").resetEdit()
    settle()
    return {"faces": faces, "left": [list(names) for _, names in made.Base], "there": made in job.Operations.Group}


@step
def finish_without_a_tool():
    document, said = new_document("bare"), []
    job = document.getObject("Job")
    document.removeObject(job.Tools.Group[0].Name)
    document.recompute()
    before = len(document.Objects)
    answer(said)
    press("PKM_SurfaceFinish", job)
    return {"said": said, "made": len(document.Objects) - before, "state": _state(document)}


main()
