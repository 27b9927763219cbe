# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control panel: the dock for connecting to a machine, monitoring and operating it.

Code without a GUI is in ``pkm_post.control.numerical_control``. Only the worker thread communicates with the
controller; the GUI polls its results ten times a second.
"""

from pkm_post.freecad_gui.control_panel.dock import ControlPanel, open_control
