# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control: the link to a controller, its simulator, numerical control and the player.

Each of these four is entered by its own door; ``loading`` is the way of a certified program to any of them.
"""

__all__ = ()
