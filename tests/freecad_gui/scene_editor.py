# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program editor: opened for a program object, errors planted, text replaced, saved, decoded and posted."""

from pathlib import Path

import FreeCAD
import FreeCADGui
from gui import FOLDER, answer, main, new_document, picture, press, step, until

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
    file = FOLDER / "program.ngc"
    file.write_text(PROGRAM, encoding="ascii")
    FreeCADGui.loadFile(str(file), "pkm_post.freecad_app.program_import")
    (obj,) = FreeCAD.ActiveDocument.Objects
    before = obj.ViewObject.RootNode.getNumChildren()
    press("PKM_Editor", obj)
    editor = _editor()
    findings = _findings(editor)
    editor.body.text.jump(7)
    FreeCADGui.SendMsgToActiveView("ViewFit")
    picture("editor.png")
    drawn = obj.ViewObject.RootNode.getNumChildren() - before
    coloured = [block.layout().formats() for block, _ in editor.body.text.lines_in_sight()]
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
    text = Path(obj.File).read_text(encoding="ascii")
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
    editor, program, document = _editor(), FreeCAD.ActiveDocument, new_document("gui")
    operations = document.getObject("Job").Operations
    before, operation = len(operations.Group), editor.decode()
    told = [operation.Label, len(operations.Group) - before]
    document.undo()
    told.append(len(operations.Group) - before)
    messages, ended = [], []
    editor.posting.ended.connect(lambda: ended.append(True))
    answer(messages)
    editor.posting.post(editor.body.file, "none", "--work-offset=0,0,250 --tool-length 1=120")
    until(lambda: ended, 60)
    files = sorted(file.name for file in FOLDER.glob("program*"))
    FreeCAD.closeDocument(program.Name)
    editor.hide()
    return {"decoded": told, "messages": messages, "files": files}


main()
