# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control: the link to a controller, its simulator, numerical control and the player.

Each of the four is its own package; ``loading`` passes a certified program to any of them.
"""
