# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compressor: smooth curves within tolerance in place of runs of short lines."""
