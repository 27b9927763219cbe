# SPDX-License-Identifier: LGPL-2.1-or-later
"""Units: the length units of part programs, by the names that options use."""

from __future__ import annotations

UNITS: dict[str, float] = {"mm": 1.0, "inch": 25.4}
"""mm per length unit."""
