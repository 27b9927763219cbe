# SPDX-License-Identifier: LGPL-2.1-or-later
"""The folder of the icons."""

from pathlib import Path

ICONS = Path(__file__).parents[2] / "resources" / "icons"
