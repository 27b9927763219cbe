# SPDX-License-Identifier: LGPL-2.1-or-later
"""Refusals: how a document object says that its input is at fault.

FreeCAD knows one way to mark an object as failed: its ``execute`` raises. It then shows the text as the status of the
object, and writes it to the Report view together with the way through the code. That way says nothing to whoever set a
property, so it is cut off where the input is at fault. It is kept where we are.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from pkm_post.model import Refused
from pkm_post.out_of_memory import memory_or_refused

Execute = Callable[[Any, Any], Any]
"""The method of a proxy by which FreeCAD has an object computed."""


def briefly_refused(execute: Execute) -> Execute:
    """Let what ``execute`` refuses, or has no memory for, leave it without the way through the code."""

    @wraps(execute)
    def brief(proxy: Any, obj: Any) -> Any:
        try:
            with memory_or_refused(obj.Label):
                return execute(proxy, obj)
        except Refused as refused:
            raise refused.with_traceback(None) from None

    return brief
