# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certificate: a program read back, played as the controller plays it, and compared with the programmed path."""

from typing import TYPE_CHECKING

from pkm_post import at_first_use
from pkm_post.certificate.certify import certify
from pkm_post.certificate.consistency import machine_fault, values_beyond_machine
from pkm_post.certificate.struts import AdjacentMotion, ProgramPoints, blocks_in_a_second

if TYPE_CHECKING:
    from pkm_post.certificate.reconstruction import reconstruct
else:
    __getattr__ = at_first_use(__name__, {"reconstruction": "reconstruct"})
