# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated machine for each test, and what operates it."""

import pytest
from station import new_station


@pytest.fixture
def station():
    return new_station()
