# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strut motions with rests, and programs in parts read back."""

import numpy as np

from pkm_post.model import StrutMotion
from pkm_post.writing.controllers.pmac import read_parts


def with_rests(every, knots, events=()):
    """A motion that rests at every so many knots and moves between them, with times that change."""
    rng = np.random.default_rng(3)
    speed = rng.normal(0, 30, (knots, 6))
    speed[::every] = 0.0
    speed[-1] = 0.0
    time_ms = np.concatenate([[0], np.cumsum(rng.integers(5, 8, knots - 1))])
    return StrutMotion(time_ms, rng.uniform(300, 1500, (knots, 6)), speed, tuple(events))


def read_back(texts, settings):
    return read_parts([(f"part{number}", text) for number, text in enumerate(texts, start=1)], settings)
