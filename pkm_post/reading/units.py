# SPDX-License-Identifier: LGPL-2.1-or-later
"""Units: the length units of part programs, by the names that options use, and dwells of a doubtful unit."""

from __future__ import annotations

UNITS: dict[str, float] = {"mm": 1.0, "inch": 25.4}
"""mm per length unit."""
LONG_DWELL = 60.0
"""s: a longer dwell may be in another unit."""
