# SPDX-License-Identifier: LGPL-2.1-or-later
import pkm_post.freecad_app.post_hook

pkm_post.freecad_app.post_hook.install()
