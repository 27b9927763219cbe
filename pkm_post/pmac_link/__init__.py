# SPDX-License-Identifier: LGPL-2.1-or-later
"""The link to a PMAC: conversations over serial line, Ethernet and ssh, download, stream, stops, status, readout."""
