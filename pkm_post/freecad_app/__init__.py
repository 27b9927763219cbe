# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD without a window: CAM jobs become programs, symmetric copies are document objects, and CAM finds the post.

Nothing is imported here: FreeCAD comes through this door when it starts.
"""
