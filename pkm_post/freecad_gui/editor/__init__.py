# SPDX-License-Identifier: LGPL-2.1-or-later
"""Editor: the dock that writes, checks, displays, posts and decodes part programs.

Code without a GUI is in ``pkm_post.reading``.
"""

from pkm_post.freecad_gui.editor.dock import ProgramEditor, open_editor
