# SPDX-License-Identifier: LGPL-2.1-or-later
"""Views: base classes of the view providers of document objects.

Takes a view object and sets its provider. Saved documents store the module names of the subclasses, never those of
these classes.
"""

from __future__ import annotations

import abc
from functools import partial
from typing import Any, ClassVar

import FreeCAD
import FreeCADGui
from pivy import coin
from PySide import QtCore

from pkm_post.freecad_gui.context_menu import add_switch
from pkm_post.freecad_gui.icons import ICONS
from pkm_post.freecad_gui.observers import UndoWatch, is_panel_open, is_shown, show_panel
from pkm_post.freecad_gui.verdict_icons import with_verdict


class View:
    """An object in the tree.

    Attributes:
        icon: file name in resources/icons.
    """

    icon: ClassVar[str]

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self

    def attach(self, vobj: Any) -> None:
        """Remember the displayed object; called for new and for restored ones."""
        self.Object = vobj.Object

    def getIcon(self) -> Any:
        """The icon in the tree, with the verdict on operations and Reach."""
        return with_verdict(str(ICONS / self.icon), getattr(self, "Object", None))

    def claimChildren(self) -> list[Any]:
        """No children: the sources of an object have their own place in the tree."""
        return []

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Called by FreeCAD to add entries to its menu: a toggle, if the object has one."""
        if hasattr(vobj.Object, "Active"):
            add_switch(menu, vobj.Object)

    def dumps(self) -> None:
        """Save nothing."""

    def loads(self, state: object) -> None:
        """Restore nothing: nothing was saved."""


class PanelView(View, abc.ABC):
    """An object whose task panel is open while FreeCAD edits it."""

    _panel: Any = None
    _edit: tuple[str, Any] = ("", None)
    """Name of the document and the transaction of the open panel."""

    @abc.abstractmethod
    def make_panel(self, obj: Any) -> Any:
        """Create the panel.

        It has a ``form``; ``begin``, which opens its transaction, and ``show``, both called again when an undo or
        a command has ended that transaction; and ``release``, which disconnects it and may be called again.
        """

    def doubleClicked(self, vobj: Any) -> bool:
        """Open the panel, or say why not."""
        return bool(vobj.Document.setEdit(vobj, 0)) or is_panel_open(vobj.Object.Label)

    def setEdit(self, vobj: Any, _mode: int = 0) -> bool:
        """Open the panel, unless another one is open."""
        if FreeCADGui.Control.activeDialog():
            return False
        panel = self.make_panel(vobj.Object)
        panel.form.destroyed.connect(lambda *_: self._lost(panel))
        self._panel, self._edit = panel, (vobj.Object.Document.Name, FreeCAD.getActiveTransaction())
        self._watch = UndoWatch(self._begin_again, vobj.Object.Document.Name)
        show_panel(panel)
        return True

    def _begin_again(self) -> None:
        if FreeCAD.getActiveTransaction() is None:  # else its own, or that of a command, whose end comes here as well
            self._panel.begin()
            self._edit = self._edit[0], FreeCAD.getActiveTransaction()
        self._panel.show()

    def unsetEdit(self, _vobj: Any, _mode: int = 0) -> bool:
        """Close the panel; FreeCAD also calls this when another object is edited, or the document closed."""
        if self._panel is not None:
            self._release()
            FreeCADGui.Control.closeDialog()
        return True

    def _release(self) -> None:
        panel, self._panel = self._panel, None
        self._watch.end()
        panel.release()
        QtCore.QTimer.singleShot(0, partial(_end_transaction, self._edit[1]))

    def _lost(self, panel: Any) -> None:
        """Leave the edit mode, which commits, when a command closes the panel, without a call of its ``reject``."""
        if panel is not self._panel:
            return
        self._release()
        document, transaction = self._edit
        if FreeCAD.getActiveTransaction() in (None, transaction) and is_shown(document):  # not that of the command
            FreeCADGui.getDocument(document).resetEdit()


def _end_transaction(transaction: Any) -> None:
    """End the transaction of a panel that an undo has deleted with its object: within the undo it cannot end."""
    if transaction is not None and FreeCAD.getActiveTransaction() == transaction:
        FreeCAD.closeActiveTransaction()


class DrawnView(View, abc.ABC):
    """An object that is also drawn in the 3D view, in one display mode.

    Attributes:
        mode: the name of the display mode.
    """

    mode: ClassVar[str]

    def attach(self, vobj: Any) -> None:
        """Create the root of the scene and draw."""
        super().attach(vobj)
        self._root = coin.SoSeparator()
        vobj.addDisplayMode(self._root, self.mode)
        self.refresh()

    @abc.abstractmethod
    def refresh(self) -> None:
        """Redraw everything below the root."""

    def getDisplayModes(self, _vobj: Any) -> list[str]:
        """The only display mode."""
        return [self.mode]

    def getDefaultDisplayMode(self) -> str:
        """The only display mode."""
        return self.mode

    def setDisplayMode(self, mode: str) -> str:
        """The only display mode."""
        return mode
