# SPDX-License-Identifier: LGPL-2.1-or-later
"""What tests of several rooms share is importable by name: machines and programs. No test asserts a time."""

import sys
from pathlib import Path

from hypothesis import HealthCheck, settings

sys.path.insert(0, str(Path(__file__).parent))

from series import cases  # noqa: E402 - from this folder

settings.register_profile(
    "busy computer", deadline=None, max_examples=cases(60), suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("busy computer")
