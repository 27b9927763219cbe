# SPDX-License-Identifier: LGPL-2.1-or-later
"""Profile: the fastest motion along a path without limits of jerk."""
