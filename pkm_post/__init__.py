# SPDX-License-Identifier: LGPL-2.1-or-later
"""PKM Post: from CAM jobs to certified motion programs of 6-TPS parallel kinematic machine tools."""

import importlib
import sys
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pkm_post.api import (
        Certificate,
        Cutter,
        DiagnosticWarning,
        EventKind,
        GcodeDialect,
        Machine,
        Options,
        Plan,
        Posted,
        Program,
        ReachReport,
        ReadingOptions,
        Refused,
        Tool,
        Trajectory,
        add_machine,
        certify,
        compensate,
        find_machine,
        job,
        jobs,
        mirror,
        place,
        plan,
        post,
        reach,
        read,
        read_machine,
        read_options,
        rotate,
        set_gauge_length,
        surface_points,
        symmetry,
        tip_from_contact,
        write,
    )

__all__ = [
    "Certificate",
    "Cutter",
    "DiagnosticWarning",
    "EventKind",
    "GcodeDialect",
    "Machine",
    "Options",
    "Plan",
    "Posted",
    "Program",
    "ReachReport",
    "ReadingOptions",
    "Refused",
    "Tool",
    "Trajectory",
    "add_machine",
    "certify",
    "compensate",
    "find_machine",
    "job",
    "jobs",
    "mirror",
    "place",
    "plan",
    "post",
    "reach",
    "read",
    "read_machine",
    "read_options",
    "rotate",
    "set_gauge_length",
    "surface_points",
    "symmetry",
    "tip_from_contact",
    "write",
]

__version__ = "0.1.0"


def at_first_use(door: str, files: Mapping[str, str]) -> Callable[[str], Any]:
    """Module ``__getattr__`` that imports each public name on first use [PEP 562], which keeps short runs fast.

    Args:
        door: name of the package.
        files: public names, separated by spaces, by the dotted name of the module that defines them; modules of the
            package itself are listed under an empty key. No other name may equal that of such a module.
    """
    file_of = {name: file for file, names in files.items() for name in names.split()}

    def attribute(name: str) -> Any:
        if name not in file_of:
            raise AttributeError(f"module {door!r} has no attribute {name!r}")
        if not file_of[name]:
            return importlib.import_module(f"{door}.{name}")
        value = getattr(importlib.import_module(f"{door}.{file_of[name]}"), name)
        setattr(sys.modules[door], name, value)
        return value

    return attribute


if not TYPE_CHECKING:
    __getattr__ = at_first_use(__name__, {"api": " ".join(__all__)})


def __dir__() -> list[str]:
    return [*globals(), *__all__]
