# SPDX-License-Identifier: LGPL-2.1-or-later
"""A simulated controller as it comes from the factory, and one with six struts that are ready to move."""

import pytest
from simulated import make, ready_machine


@pytest.fixture
def pmac():
    """As it comes from the factory, but for I3 = 2 and I6 = 1."""
    return make()


@pytest.fixture
def machine():
    return ready_machine()
