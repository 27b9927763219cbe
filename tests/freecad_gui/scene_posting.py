# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posting from the button: files and the message, or the reasons and no file."""

from gui import FOLDER, answer, main, new_document, press, step


@step
def post_command_writes_and_tells():
    document, told = new_document("gui"), []
    document.saveAs(str(FOLDER / "gui.FCStd"))
    answer(told)
    press("PKM_Post", document.getObject("Job"))
    return {"files": sorted(file.name for file in FOLDER.glob("gui*")), "told": told}


@step
def refused_job_is_told_and_leaves_nothing():
    document, told, folder = new_document("refused"), [], FOLDER / "refused"
    folder.mkdir()
    document.saveAs(str(folder / "refused.FCStd"))
    document.getObject("Custom").Gcode = ["G0 X0 Y0 Z30", "G1 X10 F0"]
    document.recompute()
    answer(told)
    press("PKM_Post", document.getObject("Job"))
    return {"files": [file.name for file in folder.iterdir()], "told": told}


main()
