# SPDX-License-Identifier: LGPL-2.1-or-later
"""Editor: the dock to write, check, display, post and decode part programs.

Code that needs no window is in ``pkm_post.reading.program_text``.
"""

from pkm_post.freecad_gui.editor.dock import ProgramEditor, open_editor

__all__ = ["ProgramEditor", "open_editor"]
