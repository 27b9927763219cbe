# SPDX-License-Identifier: LGPL-2.1-or-later
import FreeCAD

import pkm_post.freecad_app.startup

pkm_post.freecad_app.startup.install_post_processors()
pkm_post.freecad_app.startup.install_step_reader()
pkm_post.freecad_app.startup.install_package_folder()
pkm_post.freecad_app.startup.install_sanity_checks()
FreeCAD.addImportType(
    "Part program (*.ngc *.nc *.ncl *.cl *.cls *.clsf *.clt *.apt *.aptsource *.as *.cldata)",
    "pkm_post.freecad_app.program_import",
)
