# SPDX-License-Identifier: LGPL-2.1-or-later
import pkm_post.freecad_gui.workbench

pkm_post.freecad_gui.workbench.install()
