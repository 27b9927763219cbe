# SPDX-License-Identifier: LGPL-2.1-or-later
import FreeCAD

import pkm_post.freecad_app.post_hook
import pkm_post.freecad_app.step_file

pkm_post.freecad_app.post_hook.install()
pkm_post.freecad_app.step_file.install()
FreeCAD.addImportType(
    "Part program (*.ngc *.nc *.ncl *.cls *.apt *.aptsource)",
    "pkm_post.freecad_app.program_import",
)
