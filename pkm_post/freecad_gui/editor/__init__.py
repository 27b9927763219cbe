# SPDX-License-Identifier: LGPL-2.1-or-later
"""Editor: the dock in which part programs are written, checked while they are typed, shown, posted and decoded.

What needs no window is in ``pkm_post.program_text``.
"""

from pkm_post.freecad_gui.editor.dock import ProgramEditor, open_editor

__all__ = ["ProgramEditor", "open_editor"]
