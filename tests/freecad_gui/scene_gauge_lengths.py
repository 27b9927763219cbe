# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gauge lengths in the post panel: typed with units, kept in one step of undo, reported where they are missing."""

import FreeCAD
import FreeCADGui
from gui import FOLDER, click, main, new_document, picture, press, settle, step, until
from PySide import QtCore, QtWidgets

INCHES = 3
"""FreeCAD's unit scheme imperial decimal."""


class Panel:
    """The panel that is open, by its widgets."""

    def __init__(self):
        from pkm_post.freecad_gui.gauge_table import GaugeTable
        from pkm_post.freecad_gui.post_fields import PostChoices
        from pkm_post.freecad_gui.post_outcome import PostOutcome
        from pkm_post.freecad_gui.post_panel import NAME

        window = FreeCADGui.getMainWindow()
        inside = window.findChild(QtWidgets.QWidget, NAME).findChildren(QtWidgets.QWidget)
        self.gauges, self.choices, self.outcome = (
            next(each for each in inside if isinstance(each, kind)) for kind in (GaugeTable, PostChoices, PostOutcome)
        )
        self.buttons = {each.text(): each for each in inside if isinstance(each, QtWidgets.QPushButton)}
        # not asked of its box: of those in the window one may just have been deleted
        buttons = [each for each in window.findChildren(QtWidgets.QPushButton) if each.isVisible()]
        self.apply = next(each for each in buttons if each.text().replace("&", "") == "Apply")

    def field(self, row):
        return self.gauges.table.cellWidget(row, self.gauges.table.columnCount() - 1)

    def texts(self):
        return [self.field(row).text() for row in range(self.gauges.table.rowCount())]

    def cells(self):
        table = self.gauges.table
        return [[table.item(row, column).text() for column in (0, 1, 2)] for row in range(table.rowCount())]

    def type(self, row, text):
        """Type into a field, and leave it."""
        self.field(row).setText(text)
        self.field(row).editingFinished.emit()
        settle()

    def notes(self):
        return self.gauges.notes.text()

    def post(self):
        click(self.buttons["Post"])
        until(self.buttons["Post"].isEnabled, 60)

    def reported(self):
        listed = self.outcome.diagnostics
        return [listed.item(row).text() for row in range(listed.count())]


def opened(name):
    """A saved document with two tools, of which the first is used and has no gauge length, and its panel."""
    from cam_jobs import add_tool_controller

    document, folder = new_document(name), FOLDER / name
    job = document.getObject("Job")
    job.Tools.Group[0].removeProperty("GaugeLength")
    add_tool_controller(job, 2)
    document.recompute()
    folder.mkdir()
    document.saveAs(str(folder / f"{name}.FCStd"))
    document.clearUndos()
    press("PKM_Post", job)
    return document, Panel()


def lengths(document):
    return [
        tool.GaugeLength.Value if hasattr(tool, "GaugeLength") else None
        for tool in document.getObject("Job").Tools.Group
    ]


def files(document):
    return sorted(file.name for file in (FOLDER / document.Name).iterdir() if file.suffix != ".FCStd")


def close():
    FreeCADGui.Control.closeDialog()
    settle()


@step
def missing_length_is_reported_as_posting_tells_it():
    document, panel = opened("missing")
    found = {"cells": panel.cells(), "texts": panel.texts(), "notes": panel.notes()}
    found["hint"] = panel.field(0).placeholderText()
    found["drawn"] = picture("missing.png")
    panel.post()
    found |= {"reported": panel.reported(), "files": files(document), "lengths": lengths(document)}
    close()
    return found


@step
def inches_are_typed_and_posted():
    document, panel = opened("inches")
    panel.type(0, "4.5 in")
    shown = {"texts": panel.texts(), "notes": panel.notes(), "before": lengths(document)}
    panel.post()
    found = {
        **shown,
        "verdict": panel.outcome.verdict.text(),
        "lengths": lengths(document),
        "arguments": document.getObject("Job").PostProcessorArgs,
        "steps": document.UndoCount,
    }
    document.undo()
    settle()
    found["undone"] = [lengths(document), panel.texts(), "J113" in panel.notes()]
    found["arguments undone"] = document.getObject("Job").PostProcessorArgs
    document.redo()
    settle()
    found["redone"] = [lengths(document), panel.texts(), panel.notes()]
    close()
    return found


@step
def number_alone_has_the_unit_of_the_window():
    document, _ = opened("alone")
    close()
    FreeCAD.Units.setSchema(INCHES)
    press("PKM_Post", document.getObject("Job"))
    panel = Panel()
    before = panel.texts()
    panel.type(0, "4.5")
    shown = panel.texts()
    click(panel.apply)
    settle()
    kept = lengths(document)
    close()
    FreeCAD.Units.setSchema(0)
    return {"before": before, "shown": shown, "kept": kept}


@step
def what_is_no_length_is_reported_and_not_kept():
    document, panel = opened("senseless")
    job, found = document.getObject("Job"), {}
    before = job.PostProcessorArgs
    panel.choices.machine.setEditText("example_6tps")
    panel.type(1, "90 mm")
    for text in ("abc", "5 deg", "-120 mm", "12,5 cm", "0"):
        panel.type(0, text)
        notes = panel.notes()
        panel.post()
        found[text] = {"text": panel.texts()[0], "notes": notes, "reported": panel.reported()}
        click(panel.apply)
        found[text]["applied"] = panel.reported()
    found["document"] = [lengths(document), document.UndoCount, job.PostProcessorArgs == before, files(document)]
    close()
    return found


@step
def lengths_are_kept_without_posting():
    document, panel = opened("applied")
    panel.type(0, "118.75 mm")
    panel.type(1, "")
    click(panel.apply)
    settle()
    found = {"lengths": lengths(document), "steps": document.UndoCount, "reported": panel.outcome.verdict.text()}
    found |= {"files": files(document), "machine": document.getObject("Job").PostProcessorArgs}
    click(panel.apply)
    found["again"] = document.UndoCount
    close()
    return found


@step
def simulation_has_what_was_typed():
    document, panel = opened("simulated")
    panel.type(0, "110 mm")
    click(panel.buttons["Simulate"])
    until(lambda: document.getObject("Simulation") is not None and not document.Recomputing)
    settle()
    made = document.getObject("Simulation")
    found = {"lengths": lengths(document), "followable": made.Followable, "valid": made.isValid()}
    for dock in FreeCADGui.getMainWindow().findChildren(QtWidgets.QDockWidget, "PkmPlayer"):
        dock.close()
    close()
    return found


@step
def arguments_go_before_the_field():
    document, panel = opened("argued")
    panel.choices.more.setText("--tool-length 1=130")
    settle()
    found = {"notes": panel.notes()}
    panel.post()
    found |= {"verdict": panel.outcome.verdict.text(), "lengths": lengths(document)}
    panel.choices.more.setText("")
    settle()
    found["without"] = panel.notes()
    close()
    return found


@step
def table_follows_the_document():
    from cam_jobs import add_tool_controller

    document, panel = opened("followed")
    job = document.getObject("Job")
    panel.type(0, "100 mm")
    job.Tools.Group[1].GaugeLength = 95
    settle()
    changed = panel.texts()
    add_tool_controller(job, 3)
    job.Tools.Group[1].Label = "Ball"
    settle()
    more = [panel.texts(), [label for _, label, _ in panel.cells()]]
    job.Tools.Group[1].GaugeLength = 96
    click(panel.apply)  # at once, before the table has followed: what was not typed is not written
    settle()
    found = {"changed": changed, "more": more, "kept": lengths(document), "shown": panel.texts()}
    panel.type(0, "50 mm")
    close()
    return {**found, "closed": lengths(document)}


@step
def numbers_have_the_comma_of_the_language():
    """As with FreeCAD's number format set to German: its own texts are formatted by the default of Qt."""
    from pkm_post.freecad_app.user_units import amount_text
    from pkm_post.freecad_gui import quantities, symmetry_fields
    from pkm_post.freecad_gui.control_panel import dro

    before = QtCore.QLocale()
    QtCore.QLocale.setDefault(QtCore.QLocale("de_DE"))
    try:
        _, panel = opened("german")
        panel.type(0, "120,5")
        return {
            "typed": panel.texts()[0],
            "length": [quantities.length_text(2.5), amount_text(2.499, "mm"), dro.length_text(150.0)],
            "time": [quantities.seconds_text(2.31), quantities.time_text(62.5)],
            "angles": [symmetry_fields.angles_text([22.5, 90]), symmetry_fields.angles_of("22,5; 45.5", [])],
        }
    finally:
        close()
        QtCore.QLocale.setDefault(before)


@step
def a_comma_that_is_no_decimal_separator_is_not_read():
    from pkm_post.freecad_gui import symmetry_fields

    return {"angles": symmetry_fields.angles_of("90,180", [30.0])}


main()
