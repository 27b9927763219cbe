# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strut motions with rests, and programs in parts read back."""

import numpy as np

from pkm_post.model import Event, EventKind, SpindleTurns, StrutMotion
from pkm_post.writing.controllers.pmac import read_parts


def with_rests(every, knots, events=()):
    """A motion that rests at every so many knots and moves between them, with times that change."""
    rng = np.random.default_rng(3)
    speed = rng.normal(0, 30, (knots, 6))
    speed[::every] = 0.0
    speed[-1] = 0.0
    time_ms = np.concatenate([[0], np.cumsum(rng.integers(5, 8, knots - 1))])
    return StrutMotion(time_ms, rng.uniform(300, 1500, (knots, 6)), speed, tuple(events))


def threaded(job):
    """The motion of a job to its third knot, as a thread that goes down and up."""
    events = (Event(0, EventKind.SPINDLE_AXIS, 1.0), Event(2, EventKind.SPINDLE_AXIS, 0.0))
    turns = SpindleTurns(np.array([1, 2]), np.array([4.25, 0.0]), np.array([-3.5, 0.0]))
    return StrutMotion(job.time_ms[:3], job.length[:3], job.speed[:3], events, turns)


def read_back(texts, settings):
    return read_parts([(f"part{number}", text) for number, text in enumerate(texts, start=1)], settings)
