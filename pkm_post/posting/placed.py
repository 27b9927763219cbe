# SPDX-License-Identifier: LGPL-2.1-or-later
"""Placed: a program as a trajectory on its machine.

Enters: a program in {C}. Leaves: the compensated trajectory on the machine, in {M}, with its spin, or diagnostics.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import with_spin
from pkm_post.model import Diagnostic, Machine, Place, Program, Trajectory
from pkm_post.options import Options
from pkm_post.toolpath import compensate, place, with_surface_speed

Findings = tuple[Diagnostic, ...]


def trajectory_of(program: Program, machine: Machine, options: Options) -> tuple[Trajectory | None, Findings]:
    """The compensated program on the machine, with its spin; or None with diagnostics."""
    offset, told = work_offset(machine, options)
    moved, faults = compensate(program, options.contours, options.actual_tools)
    told += faults
    if offset is None or moved is None:
        return None, told
    if options.surface_speed is not None:
        limits = machine.spindle_least_speed, machine.spindle_speed
        moved, faults = with_surface_speed(moved, options.surface_speed, limits)
        told += faults
        if moved is None:
            return None, told
    placed, faults = place(moved, machine, offset)
    told += faults
    if placed is None:
        return None, told
    turned, faults = with_spin(placed, machine, options.spin)
    return turned, told + faults


def work_offset(machine: Machine, options: Options) -> tuple[Array | None, Findings]:
    """The chosen work offset, (4, 4), or None with diagnostics."""
    chosen = options.work_offset
    if not isinstance(chosen, str):
        return np.asarray(chosen, dtype=np.float64), ()
    if chosen not in machine.work_offsets:
        known = ", ".join(sorted(machine.work_offsets))
        return None, (Diagnostic("K108", Place(machine.name), f"{chosen}, the machine file has {known}"),)
    return machine.work_offsets[chosen], ()
