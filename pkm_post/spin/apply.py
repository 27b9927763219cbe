# SPDX-License-Identifier: LGPL-2.1-or-later
"""Apply: give a trajectory the spin that a policy asks for.

A trajectory enters as it was placed, with the spin of the part program or none; the same with another spin leaves.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.model import Diagnostic, Machine, Trajectory
from pkm_post.spin.optimise import optimise
from pkm_post.spin.policy import Policy, Rule
from pkm_post.spin.rules import spin_in_plane


def with_spin(
    trajectory: Trajectory, machine: Machine, policy: Policy
) -> tuple[Trajectory | None, tuple[Diagnostic, ...]]:
    """The trajectory with the spin of a policy, or where the policy does not tell it.

    Args:
        trajectory: at least one segment.
        machine: geometry and limits, for a search.
        policy: what is wanted.
    """
    if policy.rule is Rule.FILE:
        return trajectory, ()
    if policy.rule is Rule.OPTIMISED:
        return optimise(replace(trajectory, spin=np.zeros(len(trajectory))), machine, policy), ()
    if policy.rule is Rule.ZERO:
        return replace(trajectory, spin=np.zeros(len(trajectory))), ()
    spin = spin_in_plane(trajectory.axis, policy.heading, of_y=policy.rule is Rule.Y_IN_PLANE)
    open_rows = np.flatnonzero(np.isnan(spin))
    if len(open_rows):
        found = f"spin {policy.rule.value}, {len(open_rows)} of {len(spin)} moves"
        return None, (Diagnostic("K120", trajectory.place(int(open_rows[0])), found),)
    return replace(trajectory, spin=spin), ()
