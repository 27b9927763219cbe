# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report: what was made and what the certificate says, as text, JSON and pictures."""
