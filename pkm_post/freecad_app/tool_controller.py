# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool controller: the answer to CAM's question which tool controller a new operation gets."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

from PathScripts import PathUtils


@contextlib.contextmanager
def answered(controller: Any) -> Iterator[None]:
    """Answer for the user: with several CAM asks, and without a window it has nobody to ask and fails.

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
