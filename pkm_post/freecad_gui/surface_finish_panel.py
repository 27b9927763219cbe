# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish panel: the operation's page in CAM's task panel.

Takes the operation and changes its properties. CAM's panel hosts the pages: accepting it commits its transaction,
rejecting it aborts it. A table defines the rows of the page.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
import Path.Base.Gui.Util as CamUtil
import Path.Op.Gui.Base as CamGui
from PathScripts import PathUtils
from PySide import QtWidgets

from pkm_post.freecad_gui.observers import OnceClosed, keep_wrappers
from pkm_post.freecad_gui.post_fields import show_quantity
from pkm_post.freecad_gui.surface_finish_outcome import SurfaceFinishOutcome
from pkm_post.freecad_gui.verdict import FindingRows, Verdict

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_CHOICE, _QUANTITY, _FLAG = "choice", "quantity", "flag"
ROWS: tuple[tuple[str, str, str], ...] = (
    (_CHOICE, "CoolantMode", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Coolant")),
    (_CHOICE, "Lines", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Lines")),
    (_CHOICE, "Order", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Order")),
    (_CHOICE, "CutMode", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Cut mode")),
    (_FLAG, "Reversed", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Begin at the other side")),
    (_CHOICE, "StepoverMode", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Stepover by")),
    (_QUANTITY, "Stepover", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Distance")),
    (_QUANTITY, "ScallopHeight", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Scallop height")),
    (_QUANTITY, "ChordTolerance", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Chord tolerance")),
    (_QUANTITY, "AxisTolerance", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Axis tolerance")),
    (_QUANTITY, "Lead", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Lead")),
    (_QUANTITY, "Tilt", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Tilt")),
    (_QUANTITY, "ConeLimit", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Cone limit")),
    (_QUANTITY, "ApproachDistance", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Approach distance")),
    (_CHOICE, "LeadMove", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Lead-in and lead-out")),
    (_QUANTITY, "LeadLength", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Length of leads")),
    (_QUANTITY, "CheckSpacing", QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Check points, distance")),
)
"""Field type, property and label, from top to bottom."""
CHOICES: tuple[str, ...] = (
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "None"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Flood"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Mist"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Along U"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Along V"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Parallel planes"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Zigzag"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "One way"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Spiral"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Climb"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Conventional"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "As it comes"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Distance"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Scallop height"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Tangent"),
    QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Arc"),
)
"""Choices of the enumeration properties; documents store the English words."""


class SurfaceFinishPage(CamGui.TaskPanelPage):
    """The page: the outcome, the tool controller, a field per table row; and the map in the 3D view.

    The property view shows all other properties.
    """

    def initPage(self, obj: Any) -> None:
        """Show the outcome of the operation, again after each computation."""
        keep_wrappers(self.form)
        outcome = SurfaceFinishOutcome(obj, self.form.verdict, self.form.findings, self.form.again)
        self._close = OnceClosed(self.form, outcome.end)
        outcome.show()

    def cleanupPage(self, _obj: Any) -> None:
        """Remove the map from the view."""
        self._close()

    def getForm(self) -> Any:
        """Create the fields."""
        form = QtWidgets.QWidget()
        layout = QtWidgets.QFormLayout(form)
        form.verdict, form.findings = Verdict(), FindingRows()
        layout.addRow(form.verdict)
        layout.addRow(form.findings)
        form.again = QtWidgets.QPushButton(translate("PKM_SurfaceFinish", "Measure and colour again"))
        form.again.setToolTip(
            translate("PKM_SurfaceFinish", "The document keeps the worst values, not the colours: computes them again")
        )
        form.again.hide()
        layout.addRow(form.again)
        form.controllers = QtWidgets.QComboBox()
        layout.addRow(translate("PKM_SurfaceFinish", "Tool controller"), form.controllers)
        form.fields = {}
        for kind, name, label in ROWS:
            field = _FIELDS[kind]()
            field.setToolTip(translate("App::Property", self.obj.getDocumentationOfProperty(name)))
            form.fields[name] = field
            layout.addRow(translate("PKM_SurfaceFinish", label), field)
        form.quantities = {
            name: CamUtil.QuantitySpinBox(form.fields[name], self.obj, name)
            for kind, name, _ in ROWS
            if kind == _QUANTITY
        }
        return form

    def setFields(self, obj: Any) -> None:
        """Show the properties."""
        labels = [controller.Label for controller in PathUtils.getToolControllers(obj)]
        current = obj.ToolController.Label if obj.ToolController else ""
        _show(self.form.controllers, labels, labels, current)
        for kind, name, _ in ROWS:
            field = self.form.fields[name]
            if kind == _CHOICE:
                words = obj.getEnumerationsOfProperty(name)
                _show(field, [translate("PKM_SurfaceFinish", word) for word in words], words, getattr(obj, name))
            elif kind == _FLAG:
                field.setChecked(getattr(obj, name))
            else:
                _refresh(self.form.quantities[name])
                if all(bound != name for bound, _ in obj.ExpressionEngine):
                    unit = "deg" if obj.getTypeIdOfProperty(name).endswith("Angle") else "mm"
                    show_quantity(field, getattr(obj, name).Value, unit)  # Apply would round to what CAM shows

    def getFields(self, obj: Any) -> None:
        """Set the properties that differ from the fields."""
        for controller in PathUtils.getToolControllers(obj):
            if controller.Label == self.form.controllers.currentText() and controller != obj.ToolController:
                obj.ToolController = controller
        for kind, name, _ in ROWS:
            field = self.form.fields[name]
            if kind == _QUANTITY:
                self.form.quantities[name].updateProperty()
                continue
            value = field.currentData() if kind == _CHOICE else field.isChecked()
            if getattr(obj, name) != value:
                setattr(obj, name, value)

    def getSignalsForUpdate(self, obj: Any) -> list[Any]:
        """Signals for changed fields."""
        fields = self.form.fields
        return [self.form.controllers.currentIndexChanged] + [
            getattr(fields[name], _SIGNALS[kind]) for kind, name, _ in ROWS
        ]


def _show(box: Any, texts: list[str], words: list[str], current: str) -> None:
    """Fill a box with choices, with signals blocked; each shows a text for a word."""
    box.blockSignals(True)
    box.clear()
    for text, word in zip(texts, words, strict=True):
        box.addItem(text, word)
    box.setCurrentIndex(max(box.findData(current), 0))
    box.blockSignals(False)


def _refresh(quantity: Any) -> None:
    """Show the value of the property; FreeCAD 1.0 has another name for this call."""
    getattr(quantity, "updateWidget" if hasattr(quantity, "updateWidget") else "updateSpinBox")()


_FIELDS = {
    _CHOICE: QtWidgets.QComboBox,
    _QUANTITY: lambda: FreeCADGui.UiLoader().createWidget("Gui::QuantitySpinBox"),
    _FLAG: QtWidgets.QCheckBox,
}
_SIGNALS = {_CHOICE: "currentIndexChanged", _QUANTITY: "editingFinished", _FLAG: "toggled"}
