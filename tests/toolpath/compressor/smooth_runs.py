# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of short lines for the tests of the compressor: vertices (7, n + 1), and their curves."""

import numpy as np

from pkm_post.geometry import length_of
from pkm_post.toolpath.compressor.fit import fit
from pkm_post.toolpath.compressor.polylines import Allowed


def wavy(rows, chord=0.2, noise=0.0, seed=1):
    """A wave of 4 mm, upright, with even noise across it."""
    x = chord * np.arange(rows + 1)
    z = 4 * np.sin(x / 15) + np.random.default_rng(seed).uniform(-noise, noise, rows + 1)
    one = np.ones_like(x)
    return np.stack([x, np.cos(x / 9), z, 0 * one, 0 * one, one, 0 * one])


def column_like(rows, chord=0.4):
    """A circle of 30 mm that climbs, with an axis that leans outwards and spins."""
    turn = chord / 30 * np.arange(rows + 1)
    lean = 0.25 + 0.05 * np.sin(turn)
    axis = [np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)]
    return np.stack([30 * np.cos(turn), 30 * np.sin(turn), turn, *axis, 0.1 * turn])


def extents(point):
    """Path lengths of the rows."""
    return length_of(*np.diff(point[:3], axis=1))


def fitted_rows(point, tip, axis=1e-5, counts=None):
    """Curves of runs of these numbers of rows, one by default; and how far their rows are off by what is allowed."""
    counts = np.array([point.shape[1] - 1] if counts is None else counts)
    begin = np.cumsum(counts + 1) - (counts + 1)
    within = np.delete(np.arange(point.shape[1] - 1), begin[1:] - 1)
    extent = extents(point)[within]
    return fit(point, extent, counts, Allowed(np.full(len(extent), tip), np.full(len(extent), axis)))
