# SPDX-License-Identifier: LGPL-2.1-or-later
"""A controller and a short job that the tests of the controllers share."""

import numpy as np
import pytest
from controller_settings import settings_for

from pkm_post.model import Event, EventKind, StrutMotion


@pytest.fixture(scope="session")
def settings():
    return settings_for()


@pytest.fixture(scope="session")
def job():
    """Three moves with every kind of event, at knots 0, 2 and 3."""
    strut = np.arange(6)
    length = 512.0 + strut + np.array([0.0, 0.0625, 0.125, -0.5])[:, None]
    speed = np.array([0.0, 3.125, 0.0, -0.00001])[:, None] * np.ones(6)
    events = (
        Event(0, EventKind.TOOL_CHANGE, 3.0),
        Event(0, EventKind.SPINDLE, 1200.0),
        Event(0, EventKind.COOLANT, 1.0),
        Event(2, EventKind.COOLANT, 2.0),
        Event(2, EventKind.DWELL, 0.5),
        Event(2, EventKind.DWELL, 0.0),
        Event(2, EventKind.STOP, 0.0),
        Event(2, EventKind.STOP, 1.0),
        Event(2, EventKind.SPINDLE, -850.5),
        Event(3, EventKind.SPINDLE, 0.0),
        Event(3, EventKind.COOLANT, 0.0),
    )
    return StrutMotion(np.array([0, 20, 40, 1040]), length, speed, events)
