# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Tab key in panels, tables and pages: it goes to each field in turn, from top to bottom, and back by Shift-Tab.

A step returns for each window the fields that Tab does not come to, those that it comes to in another order than they
stand, and whether Shift-Tab goes back from the second one to the first one.
"""

import FreeCAD
import FreeCADGui
from control_machine import connect_and_home, posted_file, the_panel
from gui import job_on, main, press, select, settle, simulate, step, until
from PySide import QtCore, QtGui, QtWidgets

MOST_KEYS = 200
NEAR_PX = 8
"""Fields in one row."""


def fields_of(window):
    """What can be typed into or chosen from, without the parts that such a field is made of."""
    kinds = (QtWidgets.QAbstractSpinBox, QtWidgets.QComboBox, QtWidgets.QLineEdit)
    found = [each for each in window.findChildren(QtWidgets.QWidget) if isinstance(each, kinds)]
    whole = [each for each in found if not isinstance(each.parentWidget(), kinds[:2])]
    return [each for each in whole if each.isVisibleTo(window) and each.isEnabled()]


def tab(modifier=QtCore.Qt.KeyboardModifier.NoModifier):
    """Press and release Tab where the keyboard is."""
    key = QtCore.Qt.Key.Key_Tab
    if modifier != QtCore.Qt.KeyboardModifier.NoModifier:
        key = QtCore.Qt.Key.Key_Backtab
    for kind in (QtCore.QEvent.Type.KeyPress, QtCore.QEvent.Type.KeyRelease):
        at = QtWidgets.QApplication.focusWidget()
        QtWidgets.QApplication.sendEvent(at, QtGui.QKeyEvent(kind, key, modifier, "\t"))
    settle()


def hide_views():
    """Put the 3D views out of sight: with one on the screen each change of a field has the whole window drawn again."""
    for view in FreeCADGui.getMainWindow().findChild(QtWidgets.QMdiArea).subWindowList():
        view.hide()
    settle()


def in_front(window):
    """Give the keyboard to the window on the screen that a widget is part of."""
    hide_views()
    window.window().raise_()
    window.window().activateWindow()
    until(window.window().isActiveWindow, 10)


def field_at(fields):
    """The field that has the keyboard, by its number; None for a button, a list and the like."""
    at = QtWidgets.QApplication.focusWidget()
    while at is not None:
        if at in fields:
            return fields.index(at)
        at = at.parentWidget()
    return None


def said(field):
    return f"{field.metaObject().className()} {field.objectName()} {field.toolTip()}"[:80]


def tabbed(window):
    """What Tab comes to, from the first field of a window on, until it is there again."""
    in_front(window)
    fields = fields_of(window)  # those that a low dock has to scroll to as well
    places = [field.mapTo(window, QtCore.QPoint(0, field.height() // 2)) for field in fields]
    order = sorted(range(len(fields)), key=lambda row: (round(places[row].y() / NEAR_PX), places[row].x()))
    fields = [fields[row] for row in order]
    fields[0].setFocus()
    until(lambda: field_at(fields) == 0, 10)
    seen = [0]
    for _ in range(MOST_KEYS):
        tab()
        at = field_at(fields)
        if at is not None and at != seen[-1]:
            seen.append(at)
        if at == 0 and len(seen) > 1:
            break
    way = seen[: -1 if seen[-1] == 0 and len(seen) > 1 else None]
    fields[1].setFocus()
    for _ in range(MOST_KEYS):
        tab(QtCore.Qt.KeyboardModifier.ShiftModifier)
        if field_at(fields) not in (1, None):
            break
    return {
        "missed": [said(fields[row]) for row in range(len(fields)) if row not in way],
        "order": [said(fields[b]) for a, b in zip(way, way[1:], strict=False) if b < a],
        "back": field_at(fields) == 0,
        "fields": len(fields),
    }


def child(kind, name):
    (found,) = [each for each in FreeCADGui.getMainWindow().findChildren(kind, name) if each.isVisible()]
    return found


def new_job(name):
    from cam_jobs import add_operation, job_in_reach

    document = FreeCAD.newDocument(name)
    job = job_in_reach(document)
    add_operation(job)
    return document, job


@step
def post_panel():
    from cam_jobs import add_tool_controller

    document, job = new_job("post")
    for number in (2, 3):
        add_tool_controller(job, number)
    press("PKM_Post", job)
    form = child(QtWidgets.QWidget, "PkmPostPanel")
    table = next(each for each in form.findChildren(QtWidgets.QTableWidget) if each.cellWidget(0, 3) is not None)
    lengths = [table.cellWidget(row, 3) for row in range(table.rowCount())]
    in_front(form)
    lengths[0].setFocus()
    until(lambda: field_at(lengths) == 0, 10)
    rows = [0]
    for _ in lengths[1:]:
        tab()
        rows.append(field_at(lengths))
    found = {"panel": tabbed(form), "rows": rows}
    FreeCADGui.Control.closeDialog()
    return found


@step
def reach_panel():
    _, job = new_job("reach")
    press("PKM_Reach", job)
    reach = FreeCAD.ActiveDocument.getObject("Reach")
    reach.ViewObject.Proxy.doubleClicked(reach.ViewObject)
    settle()
    table = child(QtWidgets.QTableWidget, "PkmReachTable")
    in_front(table)
    table.setFocus()
    until(lambda: QtWidgets.QApplication.focusWidget() is table, 10)
    tab()
    found = {"leaves the table": QtWidgets.QApplication.focusWidget() is not table}
    FreeCADGui.getDocument(FreeCAD.ActiveDocument.Name).resetEdit()
    settle()
    return found


@step
def jog_panel():
    document, job = new_job("jog")
    press("PKM_Machine", job)
    view = document.getObject("Machine").ViewObject
    view.Proxy.doubleClicked(view)
    settle()
    panel = child(QtWidgets.QWidget, "PkmJogPanel")
    fields = fields_of(panel)
    in_front(panel)
    fields[0].setFocus()
    until(lambda: field_at(fields) == 0, 10)
    tab()
    found = {"next": field_at(fields), "panel": tabbed(panel)}
    FreeCADGui.Control.closeDialog()
    return found


@step
def operation_panels():
    import Part

    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    document, job = new_job("operations")
    found = {}
    for command in ("PKM_Mirror", "PKM_Rotate"):
        press(command, job.Operations.Group[0])
        found[command] = tabbed(SymmetryPanel.opened.form)
        SymmetryPanel.opened.accept()
        settle()
    _, job = job_on("finish", Part.makeBox(20, 20, 20), "600 mm/min")
    select(job.Model.Group[0], "Face6")
    press("PKM_SurfaceFinish")
    view = job.Operations.Group[-1].ViewObject.Proxy
    until(lambda: view.panel is not None)
    for number, page in enumerate(pages_of(view.panel.form)):
        found[f"finish {number}"] = tabbed(page)
    view.panel.accept()
    settle()
    return found


def pages_of(form):
    """The pages of a panel, each shown while it is looked at; the panel itself if it has none."""
    for box in form.findChildren(QtWidgets.QToolBox)[:1]:
        for number in range(box.count()):
            box.setCurrentIndex(number)
            settle()
            if len(fields_of(box.widget(number))) > 1:
                yield box.widget(number)
        return
    yield form


@step
def player_and_preferences():
    from pkm_post.freecad_gui.preferences import PostPreferences

    document, job = new_job("player")
    player = simulate(job)
    content, found = player.widget(), {}
    content.lists.setCurrentIndex(content.lists.count() - 1)
    settle()
    found["player"] = tabbed(content)
    player.close()
    settle()
    page = PostPreferences()
    page.loadSettings()
    page.form.show()
    settle()
    found["preferences"] = tabbed(page.form)
    page.form.close()
    return found


@step
def control_panel():
    FreeCADGui.getMainWindow().findChild(QtWidgets.QDockWidget, "Report view").show()  # as after an error: less room
    press("PKM_Control")
    face, found = the_panel().panel, {}
    face.pages.setCurrentWidget(face.connecting)
    settle()
    found["connecting"] = tabbed(face.connecting)
    connect_and_home()
    program = posted_file("slow.ngc", "G1 X20 Y0 Z150 F1200", "X20 Y10")
    face.play.read(program.with_suffix(".pkmt"))
    until(face.play.play.isEnabled, 60)
    for name in ("jog", "mdi", "program", "play"):
        face.pages.setCurrentWidget(getattr(face, name))
        settle()
        if len(fields_of(getattr(face, name))) > 1:
            found[name] = tabbed(getattr(face, name))
    the_panel().close()
    settle()
    return found


main()
