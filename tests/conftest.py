# SPDX-License-Identifier: LGPL-2.1-or-later
"""What tests of several rooms share is importable by name: machines and programs."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
