# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long random series are. ``PKM_SERIES=20`` makes all of them twenty times as long, for a night."""

import os

_TIMES = int(os.environ.get("PKM_SERIES", "1"))


def cases(usual):
    """How many cases a series has that usually has so many."""
    return usual * _TIMES
