# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certificate: a program read back, played as the controller plays it, and compared with the programmed path."""

from pkm_post.certificate.beyond_machine import beyond_machine
from pkm_post.certificate.certify import certify
from pkm_post.certificate.recovered import recovered
from pkm_post.certificate.structure import machine_fault

__all__ = [
    "beyond_machine",
    "certify",
    "machine_fault",
    "recovered",
]
