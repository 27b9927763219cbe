# SPDX-License-Identifier: LGPL-2.1-or-later
"""The link to a PMAC: protocols for serial line, Ethernet and ssh, download, streaming, stops, status, readout."""
