# SPDX-License-Identifier: LGPL-2.1-or-later
"""Property proxy: what the proxies of our document objects have in common, all of whose state is in properties.

Saved documents name the classes that inherit from this one by their modules, never this one.
"""

from __future__ import annotations

from typing import Any, ClassVar

from pkm_post.freecad_app.object_properties import READ_ONLY, Row, add_missing


class PropertyProxy:
    """A proxy that saves nothing beside the properties of its object.

    Attributes:
        properties: what people set.
        results: what is computed, for people to read.
    """

    properties: ClassVar[tuple[Row, ...]] = ()
    results: ClassVar[tuple[Row, ...]] = ()

    def __init__(self, obj: Any) -> None:
        self.add_missing_properties(obj)
        obj.Proxy = self

    def add_missing_properties(self, obj: Any) -> None:
        """Give an object of this version, or of an older one, the properties that it does not have yet."""
        add_missing(obj, self.properties)
        add_missing(obj, self.results, READ_ONLY)

    def clear_results(self, obj: Any) -> None:
        """Leave no old result to be believed, should there be an error."""
        for _, name, _, _, value in self.results:
            setattr(obj, name, value)

    def onDocumentRestored(self, obj: Any) -> None:
        """Give documents of older versions the properties they do not have yet."""
        self.add_missing_properties(obj)

    def dumps(self) -> None:
        """Nothing is saved beside the properties."""

    def loads(self, state: object) -> None:
        """Nothing was saved."""
