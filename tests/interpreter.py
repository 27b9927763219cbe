# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Python that tests start other processes with: inside FreeCAD ``sys.executable`` is FreeCAD itself."""

import sys

PYTHON = sys.executable if "python" in sys.executable else "python3"
