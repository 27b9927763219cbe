# SPDX-License-Identifier: LGPL-2.1-or-later
"""PKM Post: from CAM jobs to certified motion programs of 6-TPS parallel kinematic machine tools."""

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

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Import the API at its first use: the command line starts without NumPy."""
        if name in __all__:
            from pkm_post import api

            return getattr(api, name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *__all__]
