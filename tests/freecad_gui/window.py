# SPDX-License-Identifier: LGPL-2.1-or-later
"""A FreeCAD with a window in which scenes are run, one after the other.

FreeCAD runs this script; PKM_FOLDER is for its own files. Each line of its standard input is a scene, in JSON: its
script, the folder for what it writes, and whether others follow. Behind such a scene all that it left is closed or put
back, and modules of the tests are read anew for the next; what goes wrong with that goes to its account, too. The end
of the input, or a scene that cannot be run, is the end of FreeCAD.
"""

import json
import os
import runpy
import sys
import time
import traceback
from pathlib import Path

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtWidgets

TESTS = str(Path(__file__).parents[1])
SETTINGS = "User parameter:BaseApp/Preferences"
AT_FIRST = Path(os.environ["PKM_FOLDER"]) / "settings.xml"


def read_scene():
    """Run the scene of the next line."""
    READER.setEnabled(False)
    line = os.read(0, 1 << 16)
    try:
        if not line:
            os._exit(0)
        script, folder, others_follow = json.loads(line)
        os.environ["PKM_FOLDER"] = folder
        runpy.run_path(script)
        if others_follow:
            tidy_up()
        sys.stdout.flush()
        sys.stderr.flush()
        Path(folder, "result.part").rename(Path(folder, "result.json"))
    except BaseException:
        traceback.print_exc(file=sys.__stderr__)
        os._exit(1)
    READER.setEnabled(True)


def tidy_up():
    """Leave the window without documents and panels of ours, with the settings of the start."""
    FreeCADGui.Control.closeDialog()
    FreeCADGui.Selection.clearSelection()
    close_docks()
    for name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)
    FreeCAD.ParamGet(SETTINGS).Import(str(AT_FIRST))
    FreeCAD.Units.setSchema(SCHEMA)
    FreeCADGui.activateWorkbench(WORKBENCH)
    put_back_the_layout()
    for name, module in list(sys.modules.items()):
        if str(getattr(module, "__file__", None)).startswith(TESTS):
            del sys.modules[name]
    let_go()
    report_view().clear()


def close_docks():
    """Close the player, the editor and the control panel, and wait for the end of what they do."""
    for dock in FreeCADGui.getMainWindow().findChildren(QtWidgets.QDockWidget):
        if not dock.objectName().lower().startswith("pkm"):
            continue
        dock.close()
        while is_busy(dock):
            QtWidgets.QApplication.processEvents()
            time.sleep(0.01)


def put_back_the_layout():
    """The next document fills the room, as the start page does again, and the Report view is not in its way."""
    for area in FreeCADGui.getMainWindow().findChildren(QtWidgets.QMdiArea):
        for page in area.subWindowList():
            page.showMaximized()
    for dock in FreeCADGui.getMainWindow().findChildren(QtWidgets.QDockWidget, "Report view"):
        if dock.toggleViewAction().isChecked():
            dock.toggleViewAction().trigger()


def is_busy(dock):
    """Whether threads of a control panel or of an editor are at work."""
    console, checker = getattr(dock, "console", None), getattr(dock.widget, "checker", None)
    return bool(console and console.waits or checker and checker.busy())


def let_go():
    """Let Qt do what is due, and delete what is to be deleted."""
    for _ in range(20):
        QtWidgets.QApplication.processEvents()
    QtCore.QCoreApplication.sendPostedEvents(None, QtCore.QEvent.Type.DeferredDelete)


def report_view():
    """FreeCAD's Report view."""
    views = FreeCADGui.getMainWindow().findChildren(QtWidgets.QTextEdit)
    (report,) = [view for view in views if view.metaObject().className() == "Gui::DockWnd::ReportOutput"]
    return report


def begin():
    """Remember how the window is, and wait for scenes."""
    global READER, WORKBENCH
    FreeCAD.ParamGet(SETTINGS).Export(str(AT_FIRST))
    WORKBENCH = FreeCADGui.activeWorkbench().name()
    READER = QtCore.QSocketNotifier(0, QtCore.QSocketNotifier.Type.Read)
    READER.activated.connect(lambda *_: read_scene())


SCHEMA = FreeCAD.Units.getSchema()
QtCore.QTimer.singleShot(1500, begin)
