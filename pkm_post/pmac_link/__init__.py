# SPDX-License-Identifier: LGPL-2.1-or-later
"""The link to a Turbo PMAC: conversation, serial line and Ethernet, download, start and stop, status and readout."""
