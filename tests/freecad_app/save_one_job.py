# SPDX-License-Identifier: LGPL-2.1-or-later
"""Save a document with one job, without a word about machine or place, for `make package`; run inside FreeCAD."""

import sys

import FreeCAD as App
from cam_jobs import add_operation, new_job

document = App.newDocument("trial")
add_operation(new_job(document))
document.recompute()
document.saveAs(sys.argv[1])
