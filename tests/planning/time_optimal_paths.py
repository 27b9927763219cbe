# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths and limits for the comparison with the shortest times that are possible."""

import dataclasses

import numpy as np
from machines import example
from programs import ON_PALLET, cone, program

from pkm_post.model import Kind
from pkm_post.planning.speed_profile import stations
from pkm_post.planning.tool_path import ToolPath
from pkm_post.toolpath import Segments, compress
from pkm_post.toolpath.place import place


def _corners():
    return program([[0, 0, 60], [30, 0, 60], [30, 30, 60], [60, 30, 60], [60, 0, 60], [80, 0, 60]], feed=150.0)


def _arcs():
    centre, turn = np.full((4, 3), np.nan), np.full((4, 3), np.nan)
    centre[1:] = [[20, 0, 60], [60, 0, 60], [100, 0, 60]]
    turn[1:] = [[0, 0, -1], [0, 0, 1], [0, 0, -1]]
    kind = [Kind.RAPID, Kind.ARC, Kind.ARC, Kind.ARC]
    return program(
        [[0, 0, 60], [40, 0, 60], [80, 0, 60], [120, 0, 60]], kind=kind, centre=centre, turn=turn, feed=150.0
    )


PATHS = {"cone": lambda: cone(60, turns=0.5, tilt_deg=20.0), "corners": _corners, "arcs": _arcs}
LIMITS = {"struts slow": (120.0, 5000.0), "struts weak": (500.0, 800.0), "struts strong": (500.0, 5000.0)}
"""Strut speed in mm/s and strut acceleration in mm/s^2."""


SPEED_SHARE = 0.95
"""Share of the speeds of struts that is planned."""


def stations_of(name, limits, speed_share=1.0):
    """Machine, path and stations; nothing but the struts, at a share of their speed, and the feed is limited."""
    speed, acceleration = LIMITS[limits]
    machine = dataclasses.replace(
        example(), strut_speed=speed * speed_share, strut_acceleration=acceleration, tip_acceleration=np.inf,
        axis_speed=np.inf, rapid_speed=200.0,
    )  # fmt: skip
    made = PATHS[name]()
    trajectory, _ = place(
        dataclasses.replace(made, feed=np.where(made.kind == Kind.RAPID, np.nan, 200.0)), machine, ON_PALLET
    )
    path = _path(dataclasses.replace(trajectory, exact_stop=_at_the_end(trajectory)))
    return machine, path, stations(path)


def _path(trajectory):
    """With curves and corners of tolerances of its own: the shortest times are those of this path."""
    segments = Segments.of(trajectory)
    smoothed = segments.smoothed(compress(trajectory, segments, np.full(len(trajectory), 0.06), 0.006))
    return ToolPath.of(trajectory, 0.04, 0.004, smoothed)


def _at_the_end(trajectory):
    stops = np.zeros(len(trajectory), dtype=bool)
    stops[-1] = True
    return stops
