# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kinds: type tests of document objects, by the properties they have.

Takes an object; returns a bool. Imports nothing of CAM: commands call this in every workbench.
"""

from __future__ import annotations

from typing import Any


def is_job(item: Any) -> bool:
    """Whether an object is a CAM job."""
    return hasattr(item, "Operations") and hasattr(item, "PostProcessor")


def is_program(item: Any) -> bool:
    """Whether an object is a part program."""
    return hasattr(item, "AxisWords") and hasattr(item, "Found")


def is_simulation(item: Any) -> bool:
    """Whether an object is the simulation of a CAM job."""
    return hasattr(item, "ProblemTimes") and hasattr(item, "OperationTimes")


def is_operation(item: Any) -> bool:
    """Whether an object is an operation of a CAM job; tool controllers have paths as well."""
    others = is_job(item) or is_program(item) or hasattr(item, "ToolNumber")
    return item.isDerivedFrom("Path::Feature") and not others
