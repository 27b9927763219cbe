# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool compensation: tool tips from the programmed contour in 2D, from contact points and normals in 3D."""
