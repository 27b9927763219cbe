# SPDX-License-Identifier: LGPL-2.1-or-later
"""Path check: all checks that posting runs on a trajectory.

Takes a trajectory in {M} with machine, set-up and tolerances; returns its margins and findings.
"""

from __future__ import annotations

from pkm_post.machine import ReachReport, check_reach, find_collisions, placed_workpiece
from pkm_post.model import Diagnostic, Machine, Setup, Tolerances, Trajectory
from pkm_post.posting.run import CollisionSearch


def check_path_of(
    trajectory: Trajectory,
    machine: Machine,
    setup: Setup,
    tolerances: Tolerances,
    search: CollisionSearch = find_collisions,
) -> tuple[ReachReport, tuple[Diagnostic, ...]]:
    """Run all checks of a trajectory on its machine.

    Args:
        trajectory: in {M}, at least one segment.
        machine: its limits and bodies.
        setup: part, stock and fixtures, and the shanks of the tools.
        tolerances: allowed deviation of the tool from the trajectory.
        search: ``find_collisions``, or a function that has its result.

    Returns:
        The margins along the path, and all findings: of reach, and of collisions without a margin.
    """
    checked = check_reach(trajectory, machine, placed_workpiece(setup, trajectory))
    collisions = search(trajectory, machine, setup, tolerances)
    others = (fault for fault in collisions.faults if fault.code not in _IN_REACH)
    return checked, (*checked.faults(), *others)


_IN_REACH = ("K117", "K121")
"""Diagnostics that the margins of reach cover, too."""
