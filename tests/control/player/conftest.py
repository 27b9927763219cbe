# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes the helpers of the neighbours importable."""

import sys
from pathlib import Path

sys.path += [str(Path(__file__).parents[1] / room) for room in ("link", "numerical_control")]
