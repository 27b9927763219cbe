# SPDX-License-Identifier: LGPL-2.1-or-later
"""Views: what the view providers of document objects have in common.

A view object enters and gets its provider. Saved documents name the classes that inherit from these, never these, by
their modules.
"""

from __future__ import annotations

import abc
from typing import Any, ClassVar

from pivy import coin

from pkm_post.freecad_gui.context_menu import add_switch
from pkm_post.freecad_gui.workbench import ICONS


class View:
    """An object in the tree.

    Attributes:
        icon: file name in resources/icons.
        Object: what is shown.
    """

    icon: ClassVar[str]

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self

    def attach(self, vobj: Any) -> None:
        """Remember the object that is shown; called for new and for restored ones."""
        self.Object = vobj.Object

    def getIcon(self) -> str:
        """The icon in the tree."""
        return str(ICONS / self.icon)

    def claimChildren(self) -> list[Any]:
        """No children: what an object is made from has its own place in the tree."""
        return []

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """FreeCAD asks for the entries of the menu beside its own: a switch, where the object has one."""
        if hasattr(vobj.Object, "Active"):
            add_switch(menu, vobj.Object)

    def dumps(self) -> None:
        """Nothing is saved."""

    def loads(self, state: object) -> None:
        """Nothing was saved."""


class DrawnView(View, abc.ABC):
    """An object that is drawn in the 3D view as well, in one way.

    Attributes:
        mode: the name of the way.
    """

    mode: ClassVar[str]

    def attach(self, vobj: Any) -> None:
        """Make the root of the scene and draw."""
        super().attach(vobj)
        self._root = coin.SoSeparator()
        vobj.addDisplayMode(self._root, self.mode)
        self.refresh()

    @abc.abstractmethod
    def refresh(self) -> None:
        """Draw anew below the root, whatever is there."""

    def getDisplayModes(self, _vobj: Any) -> list[str]:
        """The one way it is shown."""
        return [self.mode]

    def getDefaultDisplayMode(self) -> str:
        """The one way it is shown."""
        return self.mode

    def setDisplayMode(self, mode: str) -> str:
        """The one way it is shown."""
        return mode
