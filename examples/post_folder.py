# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post every FreeCAD document in a folder, each job with its own arguments; a refused document does not stop the rest.

The folder is that of the active document. For many documents, `python3 -m pkm_post post *.FCStd` is faster: it posts
several at a time.
"""

from pathlib import Path

import FreeCAD

import pkm_post as pkm

folder = Path(FreeCAD.ActiveDocument.FileName).parent
already_open = set(FreeCAD.listDocuments())
for file in sorted(folder.glob("*.FCStd")):
    document = FreeCAD.openDocument(str(file))
    try:
        for job in pkm.jobs(document):
            (posted,) = pkm.post(job, out=folder / "posted")
            FreeCAD.Console.PrintMessage(f"{file.name}: {posted.program}\n")
    except pkm.Refused as refused:
        FreeCAD.Console.PrintError(f"{refused}\n")
    finally:
        if document.Name not in already_open:
            FreeCAD.closeDocument(document.Name)
