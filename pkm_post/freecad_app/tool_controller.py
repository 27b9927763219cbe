# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool controller: answers CAM's question about the tool controller of a new operation."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

from PathScripts import PathUtils


@contextlib.contextmanager
def answered(controller: Any) -> Iterator[None]:
    """Answer for the user: with several controllers CAM asks, and without a window it fails.

    Args:
        controller: the tool controller; None leaves the question to the user.
    """
    before = PathUtils.UserInput
    if controller is not None:
        PathUtils.UserInput = SimpleNamespace(selectedToolController=lambda: controller)
    try:
        yield
    finally:
        PathUtils.UserInput = before
