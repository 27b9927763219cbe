# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD without a window: CAM jobs as programs, symmetric copies as document objects, post-processors for CAM.

Imports nothing: FreeCAD loads this package at startup.
"""
