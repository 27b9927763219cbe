# SPDX-License-Identifier: LGPL-2.1-or-later
"""Long programs, and the sizes of the pieces in which posting computes their columns."""

import numpy as np

from pkm_post.certificate import diagnosis, dynamics, joints, struts, tool_spline
from pkm_post.planning import feed_plan, motion, schedule, speed_profile
from pkm_post.planning.knots import interpolation
from pkm_post.planning.profile import acceleration_limits, fastest_profile, played_acceleration, switches
from pkm_post.writing import outputs
from pkm_post.writing.controllers.pvt import reader as program_reader
from pkm_post.writing.controllers.pvt import writer
from pkm_post.writing.trajectory_file import invariants as parts
from pkm_post.writing.trajectory_file import reader as trajectory_reader

PIECES = (
    (motion, "_KNOTS_AT_ONCE"),
    (feed_plan, "_STATIONS_AT_ONCE"),
    (motion, "_STRETCH_MS"),
    (motion, "_STRETCH_ROWS"),
    (interpolation, "_INTERVALS_AT_ONCE"),
    (acceleration_limits, "_AT_ONCE"),
    (fastest_profile, "_CELLS_AT_ONCE"),
    (played_acceleration, "_AT_ONCE"),
    (switches, "_CELLS_AT_ONCE"),
    (speed_profile, "_AT_ONCE"),
    (schedule, "_AT_ONCE"),
    (struts, "_AT_ONCE"),
    (tool_spline, "_AT_ONCE"),
    (joints, "_AT_ONCE"),
    (dynamics, "_KNOTS_AT_ONCE"),
    (diagnosis, "_AT_ONCE"),
    (writer, "_ROWS_AT_ONCE"),
    (program_reader, "_CHUNK"),
    (outputs, "_CHARACTERS_AT_ONCE"),
    (parts, "SEGMENTS_PER_CHUNK"),
    (trajectory_reader, "SEGMENTS_PER_CHUNK"),
)
"""Modules and names of these sizes."""
ALL = 1 << 30


def scan(lines, leans):
    """G-code of a scan over a rough surface, with two tools, a dwell, an arc, and a tool that leans if wished for."""
    rng = np.random.default_rng(1)
    x = 0.3 * np.abs(np.arange(lines) % 400 - 200) - 30
    z = 10 + np.sin(x / 9) + rng.uniform(-0.005, 0.005, lines)
    lean = np.sin(x / 20) / 5
    axes = np.column_stack([np.sin(lean), 0 * lean, np.cos(lean)])
    words = [f" I{i:.6f} J{j:.6f} K{k:.6f}" if leans else "" for i, j, k in axes]
    rows = zip(x, np.linspace(0, 50, lines), z, words, strict=True)
    moves = [f"G1 X{a:.4f} Y{b:.4f} Z{c:.4f}{word}" for a, b, c, word in rows]
    offset = "G43.5" if leans else "G43"
    half = lines // 2
    middle = ["G4 P0.5", "G0 Z40", "T2 M6", f"{offset} H2", "S8000 M3", "G0 X0 Y0"]
    arc = [] if leans else ["G1 Z10", "G3 X10 Y0 I5 J0"]
    return "\n".join(["G21 G90 G17", "T1 M6", f"{offset} H1", "S9000 M3", "G0 X30 Y0 Z40", "F2400", *moves[:half],
                      *middle, *arc, *moves[half:], "G91 G0 Z10", "M5", "M2", ""])  # fmt: skip
