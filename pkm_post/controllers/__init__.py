# SPDX-License-Identifier: LGPL-2.1-or-later
"""Controllers: from strut motion to the text a controller plays, and from that text back to strut motion."""
