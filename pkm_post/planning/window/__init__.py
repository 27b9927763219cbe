# SPDX-License-Identifier: LGPL-2.1-or-later
"""Window: the motion along a part of a path, planned while the machine moves."""
