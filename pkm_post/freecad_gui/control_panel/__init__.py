# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control panel: the dock in which a machine is connected to, looked at and operated.

What needs no window is in ``pkm_post.numerical_control``. One thread, the worker's, talks to the controller; the window
looks ten times a second at what it found.
"""

from pkm_post.freecad_gui.control_panel.dock import ControlPanel, open_control

__all__ = ["ControlPanel", "open_control"]
