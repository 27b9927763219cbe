# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report: results and certificate of a posting, as text, JSON and pictures."""
