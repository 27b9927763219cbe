# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine view: the machine of a document in the tree and in 3D.

Takes a view object and sets its provider. A change of the pose moves transforms; another machine file builds a new
scene. Saved documents store the module of this class: module and class name are a file format.
"""

from __future__ import annotations

from typing import Any

import FreeCAD

from pkm_post.freecad_app.document import transaction
from pkm_post.freecad_app.frames import matrix_of
from pkm_post.freecad_app.machine_object import go_home, machine_of, pose_of
from pkm_post.freecad_gui.context_menu import add_commands, add_entry
from pkm_post.freecad_gui.machine_scene import MachineScene
from pkm_post.freecad_gui.views import DrawnView, PanelView
from pkm_post.model import Refused

translate = FreeCAD.Qt.translate

_MACHINE, _TOOL = ("MachineFile",), ("ToolLength", "ToolDiameter", "ToolCornerRadius")
_POSE = ("Tip", "ToolAxis", "Spin", "ToolLength", "WorkOffset", "Frame")


class MachineView(DrawnView, PanelView):
    """Draws the machine around the part.

    Attributes:
        scene: the scene of the machine; None while its file has faults.
        mover: the player, panel or machine that moves it; the pose of the properties is then ignored.
    """

    icon, mode = "machine.svg", "Machine"

    def attach(self, vobj: Any) -> None:
        """Start without a scene; called for new and for restored objects."""
        self.scene, self.mover = None, None
        super().attach(vobj)

    def updateData(self, obj: Any, name: str) -> None:
        """Follow a property of the object; FreeCAD also calls this for each one when a document is opened."""
        if name in _MACHINE or (self.scene is None and name in _POSE):
            self.refresh()
        elif self.scene is None or self.mover is not None:
            return
        elif name in (*_POSE, *_TOOL):
            self._follow(obj, tool_too=name in _TOOL)

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add the jog panel, the home pose, and the commands for the job."""
        add_entry(menu, translate("PKM_Machine", "Jog"), lambda: self.doubleClicked(vobj), self.icon)
        add_entry(menu, translate("PKM_Machine", "Move it home"), lambda: _bring_home(vobj.Object), self.icon)
        super().setupContextMenu(vobj, menu)
        add_commands(menu, vobj.Object.Job, "PKM_Reach", "PKM_Simulate", "PKM_Post")

    def make_panel(self, obj: Any) -> Any:
        """The jog panel."""
        from pkm_post.freecad_gui.jog_panel import JogPanel

        return JogPanel(obj)

    def refresh(self) -> None:
        """Rebuild the scene."""
        self._root.removeAllChildren()
        self.scene = None
        if not all(hasattr(self.Object, name) for name in (*_MACHINE, *_TOOL, *_POSE)):
            return  # FreeCAD restores the properties one by one
        try:
            self.scene = MachineScene(machine_of(self.Object))
        except Refused:
            return  # the object itself reports the fault
        self._root.addChild(self.scene.root)
        self._follow(self.Object, tool_too=True)

    def release(self, mover: Any) -> None:
        """Show the pose of the properties again, unless something else moves the machine by now."""
        if self.mover is mover:
            self.mover = None
            self.refresh()

    def _follow(self, obj: Any, tool_too: bool) -> None:
        if not any(obj.ToolAxis):
            return  # the pose does not exist; the object reports it
        self.scene.place(matrix_of(obj.Frame))
        if tool_too:
            self.scene.take_tool(obj.ToolDiameter.Value, obj.ToolCornerRadius.Value, obj.ToolLength.Value)
        self.scene.show(pose_of(obj))


def _bring_home(obj: Any) -> None:
    """Set the home pose of the machine, in one undo step."""
    document = obj.Document
    with transaction(document, translate("PKM_Machine", "Move it home")):
        go_home(obj, machine_of(obj))
    document.recompute()
