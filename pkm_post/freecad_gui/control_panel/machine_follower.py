# SPDX-License-Identifier: LGPL-2.1-or-later
"""Follower: the machine object of the document follows the machine.

Takes a machine, poses and the tool length; moves the scene of the object. The document does not change; at the end the
object shows its own pose again.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pkm_post.freecad_gui.observers import DeletionWatch
from pkm_post.geometry import Array
from pkm_post.machine import machine_named
from pkm_post.model import Machine
from pkm_post.toolpath import ToolPose

_SEEN = 1e-5
"""mm, rad: smaller changes are not visible."""


class Follower:
    """Moves one object at a time."""

    def __init__(self) -> None:
        self._view: Any = None
        self._watches: list[DeletionWatch] = []
        self._tool: tuple[float, ...] = ()
        self._seen: Array | None = None

    def begin(self, document: Any, machine: Machine) -> bool:
        """Attach to the object that shows the machine in a document; return whether there is one."""
        self.end()
        obj = None if document is None else _object_for(document, machine)
        if obj is None:
            return False
        self._view = obj.ViewObject.Proxy
        self._view.mover = self
        self._watches = [DeletionWatch(self._forget, document.Name, obj.Name)]
        return True

    def show(self, pose: ToolPose | None, tool_length: float) -> None:
        """Move to a pose; mm."""
        if self._view is None or self._view.scene is None or pose is None:
            return
        if self._view.mover is None:  # a player has closed
            self._view.mover, self._seen, self._tool = self, None, ()
        if self._view.mover is not self:
            return
        seen = np.array([*pose.tip, *pose.axis, pose.spin, tool_length])
        if self._seen is not None and np.abs(seen - self._seen).max() < _SEEN:
            return  # software rendering is slow
        self._seen = seen
        scene, obj = self._view.scene, self._view.Object
        tool = obj.ToolDiameter.Value, obj.ToolCornerRadius.Value, tool_length
        if tool != self._tool:
            self._tool = tool
            scene.take_tool(*tool)
        scene.show((pose.tip[None], pose.axis[None], np.array([pose.spin]), np.array([tool_length])))

    def end(self) -> None:
        """Restore the object's own pose."""
        view = self._view
        self._forget()
        if view is not None:
            view.release(self)

    def _forget(self) -> None:
        for watch in self._watches:
            watch.end()
        self._view, self._watches, self._tool, self._seen = None, [], (), None


def _object_for(document: Any, machine: Machine) -> Any:
    """The first object that shows the machine and is not moved by anything else."""
    for obj in document.Objects:
        if not (hasattr(obj, "MachineFile") and hasattr(obj, "OutOfLimits")):
            continue
        shown, _ = machine_named(obj.MachineFile)
        view = obj.ViewObject.Proxy
        if (
            shown is not None
            and shown.fingerprint == machine.fingerprint
            and view.scene is not None
            and view.mover is None
        ):
            return obj
    return None
