# SPDX-License-Identifier: LGPL-2.1-or-later
"""Probed features: a face, a bore or a boss measured in a work frame, and the resulting work offset.

The ball touches a face at half its diameter, so a face is one ball radius beyond the contact. A bore or boss is touched
on both sides along X, along Y through the middle of that chord, and along X again: the first chord along X need not go
through the centre, but its middle is level with it.

Input: a probe, a work frame. Output: coordinates in the frame in mm, and the origin of the frame in {M}.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pkm_post.control.numerical_control.probing import Contact, Probe
from pkm_post.model import Array

_X, _Y, _Z = np.eye(3)


@dataclass(frozen=True)
class Feature:
    """Result of a measurement.

    Attributes:
        position: (3,) in the work frame, mm; NaN in directions that were not measured.
        diameters: along X and along Y, mm; empty for a face.
        half_width: largest uncertainty of a contact due to the width of the last trial, mm.
    """

    position: Array
    diameters: tuple[float, ...]
    half_width: float

    def shift(self, nominal: Array) -> Array:
        """(3,) shift of the origin, in the work frame, that gives the feature its nominal coordinates."""
        return np.where(np.isnan(self.position), 0.0, self.position - nominal)


def origin_for(feature: Feature, machine_from_work: Array, nominal: Array) -> Array:
    """(3,) origin in {M} of the work frame in which the feature has its nominal coordinates, mm.

    Args:
        feature: measured in the frame.
        machine_from_work: (4, 4) pose of the frame.
        nominal: (3,) required coordinates; unmeasured ones are ignored.
    """
    origin: Array = machine_from_work[:3, 3] + machine_from_work[:3, :3] @ feature.shift(nominal)
    return origin


def measure_face(probe: Probe, machine_from_work: Array, along: str, within: float) -> Feature:
    """Measure the coordinate of a face square to an axis of the frame.

    Args:
        probe: in front of the face.
        machine_from_work: (4, 4) pose of the frame.
        along: direction towards the face, such as "x-".
        within: longest travel to the contact, mm.

    Raises:
        DiagnosedError, Refused, PmacError: as ``Probe.touch``.
    """
    axis, sign = "xyz".index(along[0]), 1.0 if along[1] == "+" else -1.0
    contact = probe.touch(sign * machine_from_work[:3, axis], within)
    position = np.full(3, np.nan)
    position[axis] = _in_work(contact.tip, machine_from_work)[axis] + sign * probe.settings.ball / 2
    return Feature(position, (), contact.half_width)


def measure_bore(probe: Probe, machine_from_work: Array, within: float) -> Feature:
    """Measure centre and diameters of a bore along Z of the frame; the probe ends at its centre.

    Args:
        probe: in the bore.
        machine_from_work: (4, 4) pose of the frame.
        within: longest travel from the centre line to a contact, mm.

    Raises:
        DiagnosedError, Refused, PmacError: as ``Probe.touch``.
    """

    def touch(side: Array) -> Contact:
        return probe.touch(machine_from_work[:3, :3] @ side, within)

    return _round(probe, machine_from_work, touch, probe.settings.ball)


def measure_boss(probe: Probe, machine_from_work: Array, diameter: float, depth: float, clearance: float) -> Feature:
    """Measure centre and diameters of a boss along Z of the frame; the probe ends above its centre.

    Args:
        probe: above the boss, near its centre.
        machine_from_work: (4, 4) pose of the frame.
        diameter: approximate diameter of the boss, mm.
        depth: depth of the contacts below the current position, mm.
        clearance: distance from the boss at which the ball descends, and tolerance of its position, mm.

    Raises:
        DiagnosedError, Refused, PmacError: as ``Probe.go`` and ``Probe.touch``.
    """
    rotation = machine_from_work[:3, :3]
    out = (diameter + probe.settings.ball) / 2 + clearance

    def touch(side: Array) -> Contact:
        above = probe.tip
        beside = above + out * rotation @ side
        probe.go(beside)
        probe.go(beside - depth * rotation @ _Z)
        contact = probe.touch(-rotation @ side, 2 * clearance)
        probe.go(beside)
        probe.go(above)
        return contact

    return _round(probe, machine_from_work, touch, -probe.settings.ball)


def _round(probe: Probe, machine_from_work: Array, touch: Callable[[Array], Contact], ball: float) -> Feature:
    """Measure chords along X, Y and X again, each through the middle of the previous one."""
    half_width, chords = 0.0, []
    for side in (_X, _Y, _X):
        ends = [touch(-side), touch(side)]
        direction = machine_from_work[:3, :3] @ side
        low, high = (float(each.tip @ direction) for each in ends)
        here = probe.tip
        probe.go(here + ((low + high) / 2 - float(here @ direction)) * direction)
        chords.append(abs(high - low) + ball)
        half_width = max(half_width, *(each.half_width for each in ends))
    position = _in_work(probe.tip, machine_from_work)
    position[2] = math.nan
    return Feature(position, (chords[2], chords[1]), half_width)


def _in_work(tip: Array, machine_from_work: Array) -> Array:
    """(3,) coordinates in the work frame, mm."""
    coordinates: Array = machine_from_work[:3, :3].T @ (tip - machine_from_work[:3, 3])
    return coordinates
