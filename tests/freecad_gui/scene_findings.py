# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings of a refused post: a click goes to operation, command, point and pose, in the panel and in CAM's window."""

import FreeCAD
import FreeCADGui
from gui import FOLDER, click, main, new_document, picture, press, settle, step, until
from pivy import coin
from PySide import QtWidgets

from pkm_post.freecad_app.post_job import post_job
from pkm_post.freecad_gui.post_outcome import PostOutcome
from pkm_post.freecad_gui.post_panel import NAME
from pkm_post.freecad_gui.refusal import RefusalDialog, show_refusal
from pkm_post.model import Refused


def far_away(name):
    """A job where the machine does not reach, with its machine in the document."""
    document = new_document(name)
    document.saveAs(str(FOLDER / f"{name}.FCStd"))
    job = document.getObject("Job")
    job.PostProcessorArgs = "--work-offset=600,0,200 --part none --stock none"
    document.recompute()
    press("PKM_Machine", job)
    return document, job


def clicked(document, outcome):
    """Click the first row about the struts: what is selected, and what the view shows."""
    view, camera = document.getObject("Machine").ViewObject.Proxy, FreeCADGui.activeView().getCameraNode()
    rows, before = outcome.diagnostics, view.scene._platform.matrix.getValue().getValue()
    row = next(number for number in range(rows.count()) if "K10" in rows.item(number).text())
    rows.itemClicked.emit(rows.item(row))
    settle()
    direction = camera.orientation.getValue().multVec(coin.SbVec3f(0, 0, -1)) * camera.focalDistance.getValue()
    return {
        "selected": [each.Name for each in FreeCADGui.Selection.getSelection()],
        "message": FreeCADGui.getMainWindow().statusBar().currentMessage(),
        "posed": view.mover is not None and view.scene._platform.matrix.getValue().getValue() != before,
        "height": camera.height.getValue(),
        "seen": list((camera.position.getValue() + direction).getValue()),
    }


@step
def in_the_post_panel():
    document, job = far_away("panel")
    press("PKM_Post", job)
    form = FreeCADGui.getMainWindow().findChild(QtWidgets.QWidget, NAME)
    (outcome,) = form.findChildren(PostOutcome)
    (post,) = [each for each in form.findChildren(QtWidgets.QPushButton) if each.text() == "Post"]
    click(post)
    until(post.isEnabled, 60)
    found = clicked(document, outcome) | {"saved": picture("refused_pose.png")}
    FreeCAD.closeDocument("panel")
    settle()
    return found | {"open": bool(FreeCADGui.Control.activeDialog())}


@step
def in_the_window_of_cam():
    document, job = far_away("window")
    try:
        post_job(job, out=FOLDER)
    except Refused as refused:
        show_refusal(job, refused.diagnostics)
    (window,) = FreeCADGui.getMainWindow().findChildren(RefusalDialog)
    found = clicked(document, window.outcome)
    window.reject()
    settle()
    return found | {"at rest again": document.getObject("Machine").ViewObject.Proxy.mover is None}


main()
