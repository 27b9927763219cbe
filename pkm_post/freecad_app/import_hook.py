# SPDX-License-Identifier: LGPL-2.1-or-later
"""Import hook: something is done with a module as soon as it is imported, by whomever.

So nothing heavy is imported when FreeCAD starts.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType

Then = Callable[[ModuleType], None]


def when_imported(name: str, then: Then) -> None:
    """Call a function with a module: now if it is loaded, otherwise right after it is.

    Args:
        name: of the module, with its packages.
        then: what to do with it; called once for each loading. The same function is registered once.
    """
    loaded = sys.modules.get(name)
    if loaded is not None:
        then(loaded)
    elif not any(isinstance(finder, _Finder) and finder.waits_for(name, then) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder(name, then))


class _Finder:
    """Stands before the importers of Python until its module is imported.

    Attributes:
        awaited: name of that module.
    """

    def __init__(self, name: str, then: Then) -> None:
        self.awaited, self._then = name, then

    def waits_for(self, name: str, then: Then) -> bool:
        """Whether it is for this module and this function."""
        return (self.awaited, self._then) == (name, then)

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Find the module as Python does, and call the function as soon as it is executed."""
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
