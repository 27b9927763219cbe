# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machines whose struts have no key: their screws turn with the joints."""

import dataclasses

import numpy as np

LEAD = 10.0


def screwed(machine):
    """The machine with universal joints at both ends, a lead of 10 mm, and offsets of the lengths."""
    base = np.tile([1.0, 0.0, 0.0], (6, 1))
    platform = np.tile([np.cos(0.2), np.sin(0.2), 0.0], (6, 1))
    return dataclasses.replace(
        machine, base_axes=base, platform_axes=platform, screw_lead=LEAD, platform_joint_kind="universal",
    )  # fmt: skip
