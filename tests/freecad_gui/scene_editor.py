# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program editor: opened for a program object, errors planted, text replaced, saved, decoded and posted."""

import itertools
import json
import re
import time
from pathlib import Path

import FreeCAD
import FreeCADGui
from gui import FOLDER, answer, main, new_document, picture, press, settle, step, until
from PySide import QtCore, QtGui, QtWidgets

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
    until(lambda: not editor.widget.checker.busy())
    return [editor.widget.findings.item(row).text() for row in range(editor.widget.findings.count())]


@step
def program_is_opened_and_its_editor_shows_a_block():
    file = FOLDER / "program.ngc"
    file.write_text(PROGRAM, encoding="ascii")
    FreeCADGui.loadFile(str(file), "pkm_post.freecad_app.program_import")
    (obj,) = FreeCAD.ActiveDocument.Objects
    before = obj.ViewObject.RootNode.getNumChildren()
    press("PKM_Editor", obj)
    editor = _editor()
    findings = _findings(editor)
    editor.widget.text.jump(7)
    FreeCADGui.SendMsgToActiveView("ViewFit")
    picture("editor.png")
    drawn = obj.ViewObject.RootNode.getNumChildren() - before
    coloured = [block.layout().formats() for block, _ in editor.widget.text.lines_in_sight()]
    return {
        "moves": len([each for each in obj.Path.Commands if each.Name.startswith("G")]),
        "view": type(obj.ViewObject.Proxy).__name__,
        "title": editor.windowTitle(),
        "findings": findings,
        "size": editor.widget.size.text(),
        "drawn": drawn,
        "coloured": sum(map(bool, coloured)),
        "points": editor.widget._shown._places.point.getNum(),
    }


@step
def editor_finds_planted_errors_while_they_are_typed():
    editor = _editor()
    editor.widget.text.selectAll()
    editor.widget.text.insertPlainText(PROGRAM.replace("X10 Y4", "X1..5 Y4").replace("G0 Z30\nM2", "G0 Q\nM2"))
    findings = _findings(editor)
    over = _tool_tip(editor.widget.text, 6, "1..5")
    beside = editor.widget.text.text_at(_place_of(editor.widget.text, 5, "Z5"))
    underlined = [each.cursor.selectedText() for each in editor.widget.text.extraSelections()[1:]]
    editor.widget.findings.itemClicked.emit(editor.widget.findings.item(1))
    jumped = editor.widget.text.current_line()
    editor.widget.text.undo()
    return {
        "findings": findings,
        "underlined": underlined,
        "jumped": jumped,
        "after_undo": _findings(editor),
        "tool_tips": [over, beside],
    }


def _place_of(text, line, words):
    """Where some words of a line are in the viewport."""
    block = text.document().findBlockByNumber(line - 1)
    cursor = QtGui.QTextCursor(block)
    cursor.setPosition(block.position() + block.text().index(words))
    return text.cursorRect(cursor).center()


def _tool_tip(text, line, words):
    """What Qt shows where the mouse rests on some words of a line."""
    at = _place_of(text, line, words)
    event = QtGui.QHelpEvent(QtCore.QEvent.Type.ToolTip, at, text.viewport().mapToGlobal(at))
    QtWidgets.QApplication.sendEvent(text.viewport(), event)
    return QtWidgets.QToolTip.text()


@step
def editor_replaces_renumbers_and_saves():
    (obj,) = FreeCAD.ActiveDocument.Objects
    editor = _editor()
    bar = editor.widget.find_bar
    bar.begin()
    bar.wanted.setText("y4")
    found = [bar.find_next() and editor.widget.text.current_line() for _ in range(3)]
    bar.instead.setText("Y8")
    backwards = bar.find_previous() and editor.widget.text.current_line()
    bar.replace_all()
    replaced = editor.widget.size.text()
    whole = editor.widget.text.toPlainText()
    editor.widget.text.setPlainText(whole + "M99 P10\n")
    editor.widget.renumber()
    refused = [
        editor.widget.size.text(),
        editor.widget.text.current_line(),
        editor.widget.text.toPlainText() == whole + "M99 P10\n",
    ]
    editor.widget.text.selectAll()
    editor.widget.text.insertPlainText(whole)
    editor.widget.renumber()
    title = editor.windowTitle()
    saved = editor.save()
    text = Path(obj.File).read_text(encoding="ascii")
    ys = sorted({each.Parameters["Y"] for each in obj.Path.Commands if "Y" in each.Parameters})
    bar.hide()
    return {
        "found": found,
        "backwards": backwards,
        "replaced": replaced,
        "refused": refused,
        "title": title,
        "saved": saved,
        "text": text,
        "ys": ys,
    }


@step
def editor_colours_the_lines_in_sight_of_a_large_file():
    editor = _editor()
    before, large = editor.widget.file, editor.widget.file.with_name("large.apt")
    large.write_text("UNITS/MM\nFEDRAT/600,MMPM\n" + "GOTO/1,2,3\n" * 19998, encoding="ascii")
    editor.open_file(large)
    until(lambda: not editor.widget.busy())
    last = editor.widget.text.document().findBlockByNumber(19999)
    until(lambda: editor.widget.text.document().firstBlock().layout().formats())
    out_of_sight = len(last.layout().formats())
    editor.widget.text.jump(20000)
    until(lambda: last.layout().formats())
    in_sight = len(last.layout().formats())
    until(lambda: not editor.widget.checker.busy())
    reported = {"out_of_sight": out_of_sight, "in_sight": in_sight, "size": editor.widget.size.text()}
    reported["back"] = editor.open_file(before)
    return reported


@step
def editor_shows_siemens_language_in_colours_of_its_own():
    editor = _editor()
    before, file = editor.widget.file, editor.widget.file.with_name("part.nc")
    text = 'MSG("A")\nG0 X0 Y0 Z5\nCYCLE81(10,0,2,-5)\nM30\n'
    file.write_text(text, encoding="ascii")
    editor.open_file(file)

    def colours():
        formats = editor.widget.text.document().firstBlock().layout().formats()
        return [each.format.foreground().color().name() for each in formats if each.start == 4]

    until(lambda: not editor.widget.busy() and colours())
    from pkm_post.freecad_gui.editor.text_view import DARK, LIGHT
    from pkm_post.reading import Colour

    expected = (DARK if editor.widget.text.is_dark() else LIGHT)[Colour.TEXT]
    until(lambda: colours() == [expected])
    reported = {"colours": colours(), "expected": expected}
    reported["back"] = editor.open_file(before)
    return reported


def _widest_gap(call, done):
    """Milliseconds that the window had no turn at the most, from a call until it is done; for the log.

    By the clock, and by the processor time of the window's thread, which other programs do not prolong.
    """
    turns = [(time.perf_counter(), time.thread_time())]
    timer = QtCore.QTimer()
    timer.timeout.connect(lambda: turns.append((time.perf_counter(), time.thread_time())))
    timer.start(0)
    QtCore.QTimer.singleShot(0, call)
    settle()
    until(done, 60)
    return [
        round(1000 * max(after - before for before, after in itertools.pairwise(clock)))
        for clock in zip(*turns, strict=True)
    ]


@step
def editor_leaves_the_window_its_turns_in_100000_lines():
    editor = _editor()
    body, before, large = editor.widget, editor.widget.file, editor.widget.file.with_name("long.ngc")
    heading = ["G21 G90 G17", "T1 M6", "S9000 M3", "G0 X0 Y0 Z30", "G1 Z5 F600"]
    moves = [f"G1 X{row % 500 / 10:.1f} Y{row // 500 / 10:.1f}" for row in range(99995)]
    large.write_text("\n".join([*heading, *moves]), encoding="ascii")
    body.find_bar.wanted.setText("G1 X7.0 ")
    body.find_bar.instead.setText("G1 X7.5 ")
    reported, busy = {}, {}

    def timed(name, call):
        def begin():
            call()
            busy[name] = body.text.edits.busy()

        reported[name] = _widest_gap(begin, lambda: name in busy and not body.busy())
        return body.text.toPlainText().split("\n")

    lines = {"opened": timed("open", lambda: editor.open_file(large))}
    lines["replaced"] = timed("replace all", body.find_bar.replace_all)
    lines["numbered"] = timed("renumber", body.renumber)
    lines["undone"] = timed("undo", body.text.undo)
    lines["redone"] = timed("redo", body.text.redo)
    lines["undone twice"] = timed("undo again", body.text.undo) and timed("undo replacing", body.text.undo)
    body.text.jump(50000)
    timed("type", lambda: body.text.insertPlainText("G1 X1\n"))
    timed("find nothing", body.find_bar.find_next)
    timed("save", editor.save)
    saved, size = large.read_text(encoding="ascii").split("\n"), body.size.text()
    editor.open_file(before)
    return {
        "gaps": reported,
        "in slices": [name for name, is_busy in busy.items() if is_busy],
        "opened": lines["opened"] == [*heading, *moves],
        "replaced": [lines["replaced"].count("G1 X7.5 Y0.0"), lines["replaced"][5 + 70]],
        "numbered": [lines["numbered"][0], lines["numbered"][-1]],
        "undone": [lines["undone"] == lines["replaced"], lines["undone twice"] == lines["opened"]],
        "redone": lines["redone"] == lines["numbered"],
        "saved": [len(saved), saved[49999]],
        "size": size,
    }


CONTOUR = """TOOL PATH/P,TOOL,M
TLDATA/MILL,10,0,75,0,0
MSYS/0,0,0,1,0,0,0,1,0
LOAD/TOOL,1
GOTO/-40,-10,0,0,0,1
FEDRAT/PERMIN,300
CUTCOM/LEFT
GOTO/0,-10,0
GOTO/0,50,0
CUTCOM/OFF
GOTO/-40,50,0
END-OF-PATH
"""


@step
def editor_asks_what_cl_data_leaves_open():
    editor = _editor()
    reading, before, file = editor.widget.reading, editor.widget.file, editor.widget.file.with_name("contour.cls")
    file.write_text(CONTOUR, encoding="ascii")
    offered = [[reading.axis_words.isHidden(), reading.contour_data.isHidden()]]
    editor.open_file(file)
    offered.append([reading.axis_words.isHidden(), reading.contour_data.isHidden()])
    reported = [_codes(editor)]
    reading.unit.setCurrentIndex(reading.unit.findData("mm"))
    reported.append(_codes(editor))
    reading.contour_data.setCurrentIndex(reading.contour_data.findData("contour"))
    reported.append(_codes(editor))
    ended, messages = [], []
    editor.posting.ended.connect(lambda: ended.append(True))
    answer(messages)
    editor.posting.post(file, reading.chosen(), "--work-offset=0,0,250 --tool-length 1=120")
    until(lambda: ended, 60)
    report = json.loads(file.with_name("contour-report.json").read_text(encoding="utf-8"))
    editor.open_file(before)
    after = reading.chosen()
    return {
        "offered": offered,
        "codes": reported,
        "reading": report["program"]["reading"],
        "after": [after.unit, after.contour_data],
    }


CYCLE = """UNITS/MM
LOADTL/1
FEDRAT/100,MMPM
RAPID
GOTO/0,0,50
CYCLE/DRILL,FEDTO,-7,RAPTO,2
GOTO/10,0,0
CYCLE/OFF
FINI
"""


@step
def editor_asks_who_wrote_cl_data():
    editor = _editor()
    reading, before, file = editor.widget.reading, editor.widget.file, editor.widget.file.with_name("cycle.apt")
    file.write_text(CYCLE, encoding="ascii")
    editor.open_file(file)
    reported = [_codes(editor)]
    reading.cl_dialect.setCurrentIndex(reading.cl_dialect.findData("nx"))
    reported.append(_codes(editor))
    ended, messages = [], []
    editor.posting.ended.connect(lambda: ended.append(True))
    answer(messages)
    editor.posting.post(file, reading.chosen(), "--work-offset=0,0,250 --tool-length 1=120")
    until(lambda: ended, 60)
    editor.open_file(before)
    return {
        "codes": reported,
        "posted": file.with_name("cycle-report.json").exists(),
        "after": reading.chosen().cl_dialect,
    }


def _codes(editor):
    return [re.search(r"\b[A-Z]\d{3}\b", text)[0] for text in _findings(editor)]


@step
def editor_asks_whether_a_program_may_have_no_end():
    editor = _editor()
    reading, before, file = editor.widget.reading, editor.widget.file, editor.widget.file.with_name("cut.ngc")
    file.write_text(PROGRAM.replace("M2\n", ""), encoding="ascii")
    editor.open_file(file)
    reported, size = [_codes(editor)], editor.widget.size.text()
    reading.allow_open_end.setChecked(True)
    reported.append(_codes(editor))
    editor.open_file(before)
    return {"codes": reported, "size": size, "after": reading.chosen().allow_open_end}


@step
def editor_opens_what_is_dropped():
    editor = _editor()
    before, dropped = editor.widget.file, editor.widget.file.with_name("dropped.ngc")
    dropped.write_text("G0 X1 Y2 Z3\n", encoding="ascii")
    data = QtCore.QMimeData()
    data.setUrls([QtCore.QUrl.fromLocalFile(str(dropped.with_name(name))) for name in ("a.png", "dropped.ngc")])
    _drop(editor.widget.text.viewport(), data)
    settle()
    text = editor.widget.text.toPlainText()
    editor.open_file(before)
    return {"text": text, "keys": sorted(action.shortcut().toString() for action in editor.actions())}


def _drop(widget, data):
    """Drag something into a widget and drop it there, as the window system would tell it."""
    place, copy = QtCore.QPoint(5, 5), QtCore.Qt.DropAction.CopyAction
    button, keys = QtCore.Qt.MouseButton.LeftButton, QtCore.Qt.KeyboardModifier.NoModifier
    QtWidgets.QApplication.sendEvent(widget, QtGui.QDragEnterEvent(place, copy, data, button, keys))
    QtWidgets.QApplication.sendEvent(widget, QtGui.QDropEvent(QtCore.QPointF(place), copy, data, button, keys))


@step
def editor_keeps_reading_options_with_their_text():
    editor, (obj,) = _editor(), FreeCAD.ActiveDocument.Objects
    body, before, dialogs = editor.widget, editor.widget.file, QtWidgets.QFileDialog
    other, renamed, ask = before.with_name("other.ngc"), before.with_name("renamed.ngc"), dialogs.getSaveFileName
    obj.BlockDelete, obj.Origins = True, ["G55=100,0,0"]
    editor.open_file(before)
    reported = [[body.reading.chosen().block_delete, list(body.reading.chosen().work_offsets)]]
    other.write_text(PROGRAM.replace("G21 ", ""), encoding="ascii")
    editor.open_file(other)
    reported.append([body.reading.chosen().block_delete, list(body.reading.chosen().work_offsets)])
    body.reading.unit.setCurrentIndex(body.reading.unit.findData("inch"))
    dialogs.getSaveFileName = staticmethod(lambda *_: (str(renamed), ""))
    try:
        editor.save_as()
    finally:
        dialogs.getSaveFileName = ask
    findings, size = _findings(editor), body.size.text()
    reported.append([body.file == renamed, body.reading.chosen().unit])
    obj.BlockDelete, obj.Origins = False, []
    editor.open_file(before)
    return {"reported": reported, "findings": findings, "size": size}


@step
def editor_shows_its_context_menu():
    text, place, shown, timer = _editor().widget.text, QtCore.QPoint(5, 5), [], QtCore.QTimer()

    def look():
        menu = QtWidgets.QApplication.activePopupWidget()
        if menu is not None:
            shown.extend(action.objectName() for action in menu.actions())
            menu.close()

    timer.timeout.connect(look)
    timer.start(50)
    event = QtGui.QContextMenuEvent(QtGui.QContextMenuEvent.Reason.Mouse, place, text.mapToGlobal(place))
    QtWidgets.QApplication.sendEvent(text.viewport(), event)  # until the menu is closed
    timer.stop()
    return {"shown": shown}


@step
def editor_decodes_and_posts():
    editor, program, document = _editor(), FreeCAD.ActiveDocument, new_document("gui")
    operations = document.getObject("Job").Operations
    before, operation = len(operations.Group), editor.decode()
    reported = [operation.Label, len(operations.Group) - before]
    document.undo()
    reported.append(len(operations.Group) - before)
    messages, ended = [], []
    editor.posting.ended.connect(lambda: ended.append(True))
    answer(messages)
    editor.posting.post(editor.widget.file, editor.widget.reading.chosen(), "--work-offset=0,0,250 --tool-length 1=120")
    until(lambda: ended, 60)
    files = sorted(file.name for file in FOLDER.glob("program*"))
    FreeCAD.closeDocument(program.Name)
    editor.hide()
    return {"decoded": reported, "messages": messages, "files": files}


main()
