# SPDX-License-Identifier: LGPL-2.1-or-later
"""Import hook: calls a function as soon as a module is imported, whoever imports it.

This keeps heavy imports out of FreeCAD's startup.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType

Then = Callable[[ModuleType], None]


def when_imported(name: str, then: Then) -> None:
    """Call a function with a module: now if it is loaded, otherwise right after its import.

    Args:
        name: full name of the module.
        then: the function; called once per loading. The same function is registered only once.
    """
    loaded = sys.modules.get(name)
    if loaded is not None:
        then(loaded)
    elif not any(isinstance(finder, _Finder) and finder.waits_for(name, then) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder(name, then))


class _Finder:
    """Finder placed before Python's importers until its module is imported.

    Attributes:
        awaited: name of that module.
    """

    def __init__(self, name: str, then: Then) -> None:
        self.awaited, self._then = name, then

    def waits_for(self, name: str, then: Then) -> bool:
        """Whether the finder is for this module and this function."""
        return (self.awaited, self._then) == (name, then)

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Find the module as Python does, and call the function after its execution."""
        if name != self.awaited:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        if spec is not None and spec.loader is not None:
            spec.loader.exec_module = self._followed(spec.loader.exec_module)
        return spec

    def _followed(self, execute: Then) -> Then:
        def exec_module(module: ModuleType) -> None:
            execute(module)
            self._then(module)

        return exec_module
