# SPDX-License-Identifier: LGPL-2.1-or-later
"""Property proxy: base class of our document objects' proxies, which keep all their state in properties.

Saved documents store the module names of the subclasses, never this one.
"""

from __future__ import annotations

from typing import Any, ClassVar

from pkm_post.freecad_app.object_properties import READ_ONLY, Row, add_missing


class PropertyProxy:
    """A proxy that saves nothing but the properties of its object.

    Attributes:
        properties: set by the user.
        results: computed, read-only for the user.
    """

    properties: ClassVar[tuple[Row, ...]] = ()
    results: ClassVar[tuple[Row, ...]] = ()

    def __init__(self, obj: Any) -> None:
        self.add_missing_properties(obj)
        obj.Proxy = self

    def add_missing_properties(self, obj: Any) -> None:
        """Add the properties that the object lacks, whether new or from an older version."""
        add_missing(obj, self.properties)
        add_missing(obj, self.results, READ_ONLY)

    def clear_results(self, obj: Any) -> None:
        """Clear the results, so that none is outdated after an error."""
        for _, name, _, _, value in self.results:
            setattr(obj, name, value)

    def onDocumentRestored(self, obj: Any) -> None:
        """Add the properties that documents of older versions lack."""
        self.add_missing_properties(obj)

    def dumps(self) -> None:
        """Save nothing but the properties."""

    def loads(self, state: object) -> None:
        """Restore nothing: nothing was saved."""
