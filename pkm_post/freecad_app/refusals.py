# SPDX-License-Identifier: LGPL-2.1-or-later
"""Refusals: reports faulty input of a document object.

FreeCAD has one way to mark an object as failed: its ``execute`` raises. It then shows the text as the status of the
object, and writes it to the Report view with the traceback. The traceback does not help the user who set a property,
so it is removed where the input is at fault, and kept for errors of our own.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from pkm_post.model import Refused
from pkm_post.system import memory_guard

Execute = Callable[[Any, Any], Any]
"""The method of a proxy that computes its object."""


def briefly_refused(execute: Execute) -> Execute:
    """Remove the traceback from refusals and memory errors that ``execute`` raises."""

    @wraps(execute)
    def brief(proxy: Any, obj: Any) -> Any:
        try:
            with memory_guard(obj.Label):
                return execute(proxy, obj)
        except Refused as refused:
            raise refused.with_traceback(None) from None

    return brief
