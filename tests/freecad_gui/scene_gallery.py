# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every panel, dialog, dock, page of preferences and menu of the workbench: a picture of each, and what does not fit.

Language, theme, scale and size of the screen are those with which FreeCAD was started. A step returns what
``window_faults`` finds, and the least width of the window. Only with PKM_GALLERY are pictures of the screen taken.
"""

import os

import FreeCAD
import FreeCADGui
from control_machine import connect_and_home, posted_file, the_panel
from gui import FOLDER, click, job_on, main, new_document, press, select, settle, simulate, step, until
from gui import picture as picture_of_the_screen
from PySide import QtCore, QtGui, QtWidgets
from window_faults import faults_of

from pkm_post.freecad_app import surface_check

FAULTY = "G21 G90 G17\nT1 M6\nS9000 M3\nG0 X0 Y0 Z30\nG1 Z5 F600\nG1 X1..5 Y4 F900\nG2 X20 Y4 I5 J0\nG0 Q\nM2\n"
IN_REACH = "--machine example_6tps --work-offset=0,0,250"
OUT_OF_REACH = "--machine example_6tps --work-offset=600,0,200 --part none --stock none"
surface_check._MOST_CLOSE = 1000  # how closely gouges are looked for is none of this scene's matter
IS_GALLERY = "PKM_GALLERY" in os.environ
PAGES = ("connecting", "homing", "jog", "mdi", "program", "play")


def language():
    return FreeCAD.ParamGet("User parameter:BaseApp/Preferences/General").GetString("Language", "English")


def picture(name):
    """A picture of the whole screen, for a gallery."""
    return picture_of_the_screen(name) if IS_GALLERY else settle()


def seen(name, window, ours=None):
    """Keep pictures of the screen and of the window by itself; what is wrong with it, or with our part of it."""
    picture(f"screen_{name}.png")
    window.grab().save(str(FOLDER / f"{name}.png"))
    return {"faults": faults_of(ours or window, language()), "width": window.minimumSizeHint().width()}


def dock(name):
    return FreeCADGui.getMainWindow().findChild(QtWidgets.QDockWidget, name)


def panel(name):
    return FreeCADGui.getMainWindow().findChild(QtWidgets.QWidget, name)


def when_modal(look):
    """Call it with the modal window that will open, which it must close."""

    def try_it():
        window = QtWidgets.QApplication.activeModalWidget()
        if window is None:
            QtCore.QTimer.singleShot(100, try_it)
        else:
            look(window)

    QtCore.QTimer.singleShot(100, try_it)


ASKED = []


def close_questions():
    """Close each message box that opens, and keep what it says and a picture of it: a scene must not wait for it."""
    box = QtWidgets.QApplication.activeModalWidget()
    if isinstance(box, QtWidgets.QMessageBox) and box.objectName() != "PKM_InstallPackages":
        ASKED.append([box.windowTitle(), box.text()])
        picture(f"screen_question_{len(ASKED)}.png")
        box.accept()


def saved(name, arguments=IN_REACH):
    document, folder = new_document(name), FOLDER / name
    folder.mkdir()
    document.saveAs(str(folder / f"{name}.FCStd"))
    document.getObject("Job").PostProcessorArgs = arguments
    document.recompute()
    return document


def press_post(form):
    """Press the button of the post panel, and wait for the end."""
    text = FreeCAD.Qt.translate("PostPanel", "Post")
    (post,) = [each for each in form.findChildren(QtWidgets.QPushButton) if each.text() == text]
    click(post)
    until(post.isEnabled, 60)


@step
def start_page_has_the_example():
    for button in FreeCADGui.getMainWindow().findChildren(QtWidgets.QPushButton):
        if button.isVisible() and button.parentWidget().metaObject().className() == "StartGui::FirstStartWidget":
            QtCore.QTimer.singleShot(0, button.click)  # Done, of the questions at the first start; it goes with them
    settle()
    picture("screen_start.png")
    (button,) = [each for each in FreeCADGui.getMainWindow().findChildren(QtWidgets.QPushButton, "PkmPostExample")]
    button.click()
    settle()
    operation = FreeCAD.ActiveDocument.getObject("Job").Operations.Group[0]
    picture("screen_example.png")
    return {"passes": operation.PassCount, "valid": operation.isValid()}


@step
def menus_open():
    found = {}
    for workbench, texts in (("PkmPostWorkbench", ("PKM Post",)), ("CAMWorkbench", ("CAM", "PKM Post"))):
        FreeCADGui.activateWorkbench(workbench)
        settle()
        for action in FreeCADGui.getMainWindow().menuBar().actions():
            if action.menu() is None or action.text().replace("&", "") not in texts:
                continue
            place = FreeCADGui.getMainWindow().menuBar().actionGeometry(action).bottomLeft()
            action.menu().popup(FreeCADGui.getMainWindow().menuBar().mapToGlobal(place))
            name = f"menu_{workbench}_{action.text().replace('&', '').replace(' ', '')}"
            found[name] = seen(name, action.menu())
            action.menu().hide()
    return found


@step
def symmetry_panels_open():
    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    document, found = saved("symmetry"), {}
    for command in ("PKM_Mirror", "PKM_Rotate"):
        press(command, document.getObject("Custom"))
        found[command] = seen(command, SymmetryPanel.opened.form)
        SymmetryPanel.opened.accept()
        settle()
    press("PKM_NormalCompensation", document.getObject("Custom"))
    select(document.getObject("Job").Operations.Group[-1])
    picture("screen_compensation.png")
    return found


@step
def surface_finish_opens():
    import Part

    from pkm_post.freecad_app.tools import set_gauge_length

    _, job = job_on("finish", Part.makeBox(20, 20, 20))
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", IN_REACH
    set_gauge_length(job.Tools.Group[0], 120)
    select(job.Model.Group[0], "Face6")
    press("PKM_SurfaceFinish")
    view = job.Operations.Group[-1].ViewObject.Proxy
    until(lambda: view.panel is not None)
    found = {"finish": seen("finish", view.panel.form)}
    boxes = view.panel.form.findChildren(QtWidgets.QToolBox)
    for box in boxes[:1]:
        for number in range(box.count()):
            box.setCurrentIndex(number)
            found[f"finish {number}"] = seen(f"finish_{number}", view.panel.form)
    view.panel.accept()
    settle()
    return found


@step
def a_gouge_is_shown_on_the_part():
    """The floor of a groove by a mill that reaches into its walls: a map with its legend, in red where it is deep."""
    import Part

    from pkm_post.freecad_app.tools import set_gauge_length

    block, job = job_on(
        "gouge", Part.makeBox(20, 20, 20).cut(Part.makeBox(8, 20, 5, FreeCAD.Vector(6, 0, 15))), "600 mm/min"
    )
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", IN_REACH
    set_gauge_length(job.Tools.Group[0], 120)
    floor = max(range(1, 11), key=lambda n: -abs(block.Shape.getElement(f"Face{n}").CenterOfMass.z - 15.0))
    select(job.Model.Group[0], f"Face{floor}")
    press("PKM_SurfaceFinish")
    operation = job.Operations.Group[-1]
    view = operation.ViewObject.Proxy
    until(lambda: view.panel is not None)
    job.Document.recompute()
    settle()
    FreeCADGui.activeView().viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    found = {"gouge": seen("gouge", view.panel.form), "depth": operation.MaximumGouge, "valid": operation.isValid()}
    view.panel.accept()
    settle()
    return found


@step
def stiffness_panel_opens():
    document = saved("stiffness")
    press("PKM_Stiffness", document.getObject("Job"))
    form, found = panel("PkmStiffnessPanel"), {}
    FreeCADGui.activeView().viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    found["stiffness"] = seen("stiffness", form)
    form.findChild(QtWidgets.QCheckBox).setChecked(True)
    FreeCADGui.SendMsgToActiveView("ViewFit")
    found["stiffness of the table"] = seen("stiffness_table", form)
    FreeCADGui.Control.closeDialog()
    return found


@step
def post_panel_shows_certificate_and_refusal():
    document = saved("posted")
    press("PKM_Post", document.getObject("Job"))
    form = panel("PkmPostPanel")
    found = {"post": seen("post", form)}
    text = FreeCAD.Qt.translate("PostPanel", "Post")
    (post,) = [each for each in form.findChildren(QtWidgets.QPushButton) if each.text() == text]
    click(post)
    found["posting"] = seen("posting", form)
    until(post.isEnabled, 60)
    press_post(form)
    found["posted"] = seen("posted", form)
    FreeCADGui.Control.closeDialog()
    document = saved("refused", OUT_OF_REACH)
    press("PKM_Post", document.getObject("Job"))
    form = panel("PkmPostPanel")
    press_post(form)
    found["refused"] = seen("refused", form)
    FreeCADGui.Control.closeDialog()
    return found


def mouse(widget, at, kind, button):
    """Send an event of the mouse to a widget."""
    there, none = QtCore.QPointF(widget.mapToGlobal(at)), QtCore.Qt.KeyboardModifier.NoModifier
    QtWidgets.QApplication.sendEvent(widget, QtGui.QMouseEvent(kind, QtCore.QPointF(at), there, button, button, none))


def code_is_clicked(rows):
    """Click on the code in the first row of a list, where the pointer says that it is; the title of what opens."""
    area = rows.visualItemRect(rows.item(0))
    for x in range(area.left(), area.right(), 4):
        for y in range(area.top() + 6, area.bottom(), 8):
            at = QtCore.QPoint(x, y)
            mouse(rows.viewport(), at, QtCore.QEvent.Type.MouseMove, QtCore.Qt.MouseButton.NoButton)
            if rows.viewport().cursor().shape() != QtCore.Qt.CursorShape.PointingHandCursor:
                continue
            for kind in (QtCore.QEvent.Type.MouseButtonPress, QtCore.QEvent.Type.MouseButtonRelease):
                mouse(rows.viewport(), at, kind, QtCore.Qt.MouseButton.LeftButton)
            if panel("PkmFaultPage") is not None:
                return {"title": panel("PkmFaultPage").windowTitle(), "first": rows.item(0).text()}
    return {}


@step
def refusal_of_cam_opens():
    FreeCADGui.activateWorkbench("CAMWorkbench")
    document = saved("cam_refused", OUT_OF_REACH)
    document.getObject("Job").PostProcessorOutputFile = str(FOLDER / "cam_refused" / "cam_refused.pmc")
    FreeCAD.setActiveDocument(document.Name)
    press("CAM_Post", document.getObject("Job"))
    window = panel("PkmRefusal")
    found = {"refusal": seen("refusal", window)}
    rows = window.outcome.diagnostics
    rows.setFocus()
    rows.setCurrentRow(0)
    found["links"] = code_is_clicked(rows)
    listed = panel("PkmFaultPage").findChild(QtWidgets.QTextBrowser)
    settle()
    found["links"] |= {"scrolled": listed.verticalScrollBar().value(), "has": "K102" in listed.toPlainText()}
    found["fault page"] = seen("fault_page", panel("PkmFaultPage"))
    panel("PkmFaultPage").close()
    window.reject()
    return found


def seen_axes(reach):
    """Draw all tool axes; the lightness of their colour and of the ground of the theme, of 255."""
    from pkm_post.freecad_gui.axis_vectors import axis_vectors
    from pkm_post.freecad_gui.preferences import set_every_nth
    from pkm_post.freecad_gui.theme import theme

    set_every_nth(1)
    picture("screen_axes.png")
    drawn = axis_vectors(reach.Proxy.study.reach.trajectory, 1)
    drawn.ref()  # its children go with it
    axis = QtGui.QColor.fromRgbF(*drawn.getChild(2).rgb[0].getValue())
    set_every_nth(0)
    return {"axis": axis.lightness(), "ground": QtGui.QColor(theme().ground).lightness()}


@step
def reach_panel_opens():
    found = {}
    for name, arguments in (("reach", IN_REACH), ("reach_out", OUT_OF_REACH)):
        document = saved(name, arguments)
        press("PKM_Reach", document.getObject("Job"))
        reach = document.getObject("Reach")
        FreeCADGui.activeView().viewIsometric()
        FreeCADGui.SendMsgToActiveView("ViewFit")
        reach.ViewObject.Proxy.doubleClicked(reach.ViewObject)
        settle()
        table = FreeCADGui.getMainWindow().findChild(QtWidgets.QTableWidget, "PkmReachTable")
        found[name] = seen(name, table.parentWidget())
        if name == "reach":
            table.cellClicked.emit(0, 0)
            found["reach check"] = seen("reach_check", table.parentWidget())
            found["axes"] = seen_axes(reach)
        FreeCADGui.getDocument(document.Name).resetEdit()
        settle()
    return found


@step
def machine_is_shown():
    document = saved("machine")
    press("PKM_Machine", document.getObject("Job"))
    FreeCADGui.activeView().viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    select(document.getObject("Machine"))
    picture("screen_machine.png")
    view = document.getObject("Machine").ViewObject
    view.Proxy.doubleClicked(view) if hasattr(view.Proxy, "doubleClicked") else None
    settle()
    found = {"jog": seen("jog", panel("PkmJogPanel"))}
    FreeCADGui.Control.closeDialog()
    return found


@step
def player_shows_its_pages():
    document = saved("player")
    press("PKM_Machine", document.getObject("Job"))
    player, found = simulate(document.getObject("Job")), {}
    content = player.widget()
    player.go_to(player.simulation.duration / 2)
    for number in range(content.lists.count()):
        content.lists.setCurrentIndex(number)
        found[f"player {number}"] = seen(f"player_{number}", player)
    content.material.resolution.setCurrentIndex(1)
    until(lambda: content.material.is_current)
    content.material.compared.setChecked(True)
    content.show_page(content.material)
    FreeCADGui.activeView().viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    found["player with a legend"] = seen("player_legend", player)
    content.material.resolution.setCurrentIndex(0)

    def look(dialog):
        picture("screen_film.png")
        films.append(dialog.windowTitle())  # all else of it is Qt's
        dialog.reject()

    films = []
    for signal in (player.controls.animation, player.controls.pictures):
        when_modal(look)
        signal.emit()
    found["films"] = films
    window = FreeCADGui.getMainWindow()
    window.addDockWidget(QtCore.Qt.DockWidgetArea.LeftDockWidgetArea, player)
    window.resizeDocks([player], [380], QtCore.Qt.Orientation.Horizontal)
    found["player at the side"] = seen("player_side", player)
    player.close()
    settle()
    return found


@step
def editor_shows_faults():
    file, found = FOLDER / "faulty.ngc", {}
    file.write_text(FAULTY, encoding="ascii")
    press("PKM_Editor")
    editor = dock("PKM_Editor")
    editor.open_file(file)
    until(lambda: not editor.widget.checker.busy())
    until(lambda: editor.widget.findings.count())
    found["editor"] = seen("editor", editor)
    editor.widget.find_bar.begin()
    found["editor find"] = seen("editor_find", editor)

    def look(window):
        found["editor post"] = seen("editor_post", window)
        window.reject()

    when_modal(look)
    editor.post()
    editor.close()
    settle()
    return found


@step
def control_panel_shows_its_pages():
    press("PKM_Control")
    found = {"control": seen("control", the_panel())}
    connect_and_home()
    face = the_panel().panel
    for name in PAGES:
        face.pages.setCurrentWidget(getattr(face, name))
        found[name] = seen(f"control_{name}", the_panel())
        found[f"page {name}"] = {"faults": [], "width": getattr(face, name).minimumSizeHint().width()}
    program = posted_file("slow.ngc", "G1 X20 Y0 Z150 F1200", "X20 Y10")
    face.play.read(program.with_suffix(".pkmt"))
    until(face.play.play.isEnabled, 60)
    click(face.play.play)
    until(lambda: the_panel().console.play is not None and the_panel().console.play.state is not None, 60)
    until(lambda: face.progress.text() and face.play.place.text(), 60)
    found["playing"] = seen("control_playing", the_panel())
    click(face.stops.abort)
    until(lambda: the_panel().console.play is None, 60)
    the_panel().close()
    settle()
    return found


@step
def packages_are_listed():
    press("PKM_InstallPackages")
    (box,) = [each for each in QtWidgets.QApplication.topLevelWidgets()
              if each.objectName() == "PKM_InstallPackages" and each.isVisible()]  # fmt: skip
    found = {"packages": seen("packages", box)}
    box.reject()
    settle()
    return found


@step
def preferences_open():
    from pkm_post.freecad_gui.post_fields import PostChoices
    from pkm_post.freecad_gui.preferences import PAGES as GROUP

    found = {}

    def look(window):
        page = window.findChild(PostChoices).parentWidget()  # FreeCAD's list of pages has English names beside it
        found["preferences"] = seen("preferences", window, page)
        window.reject()

    when_modal(look)
    FreeCADGui.showPreferences(GROUP, 0)
    return found


@step
def nothing_was_asked():
    return {"asked": ASKED}


@step
def trees_have_menus():
    found = {}
    for document in FreeCAD.listDocuments().values():
        for item in document.Objects:
            proxy = getattr(item.ViewObject, "Proxy", None)
            if type(proxy).__module__.startswith("pkm_post") and hasattr(proxy, "setupContextMenu"):
                menu = QtWidgets.QMenu(FreeCADGui.getMainWindow())
                proxy.setupContextMenu(item.ViewObject, menu)
                menu.popup(FreeCADGui.getMainWindow().mapToGlobal(QtCore.QPoint(300, 200)))
                found[item.Name] = seen(f"menu_of_{item.Name}", menu)
                menu.hide()
    return found


TIMER = QtCore.QTimer()
TIMER.timeout.connect(close_questions)
TIMER.start(1000)
main()
