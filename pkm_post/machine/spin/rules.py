# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rules: the spin that keeps an axis of the platform parallel to a vertical plane.

Takes tool axes; returns spins, in rad. A rule uses one pose at a time and ignores the limits of the machine. Keeping
the x axis of the platform in the vertical plane of the heading C is the same as keeping the angle C of R = Rz(C) Ry(B)
Rx(A).
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, cross, norm, torsion

_NO_DIRECTION = 1e-6
"""Below this sine the tool axis is normal to the plane, which leaves the spin undefined."""


def spin_in_plane(axis: Array, heading: float, of_y: bool = False) -> Array:
    """Spins that keep an axis of the platform parallel to a vertical plane, (N,) rad, without jumps by full turns.

    Args:
        axis: (N, 3) unit tool axes in {M}, in order along the path.
        heading: direction of the x axis of the platform when the tool is upright, rad from x towards y.
        of_y: whether the y axis stays in its plane instead of the x axis.

    Returns:
        The spins; NaN where the tool axis is normal to the plane, which leaves the spin undefined.
    """
    cosine, sine = np.cos(heading), np.sin(heading)
    kept = cross(axis, np.array([cosine, sine, 0.0])) if of_y else cross(np.array([-sine, cosine, 0.0]), axis)
    x = cross(kept, axis) if of_y else kept
    spin = torsion(axis, x)
    spin[norm(kept) < _NO_DIRECTION] = np.nan
    known = np.flatnonzero(~np.isnan(spin))
    spin[known] = np.unwrap(spin[known])
    return spin
