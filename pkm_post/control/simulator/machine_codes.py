# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine codes: the programs that a machine builder supplies for codes G, M, T and D, for a machine without hardware.

M3, M4 and M5 write 1, -1 and 0 to P7001, M8, M7 and M9 write 1, 2 and 0 to P7002; M0 and M1 stop until R; T accepts any
tool from 0 to 99, and M6 changes it instantly.
"""

from __future__ import annotations

_EFFECTS = {
    0: "STOP", 1: "STOP", 3: "P7001=1", 4: "P7001=-1", 5: "P7001=0", 7: "P7002=2", 8: "P7002=1", 9: "P7002=0",
}  # fmt: skip
_M_CODES = (*range(10), 30)
_TOOLS = 100

MACHINE_CODES: tuple[str, ...] = (
    "CLOSE",
    "OPEN PROG 1001 CLEAR",
    *(f"N{1000 * code} {_EFFECTS.get(code, '')} RETURN" for code in _M_CODES),
    "CLOSE",
    "OPEN PROG 1002 CLEAR",
    *(f"N{1000 * tool}" for tool in range(_TOOLS)),
    "CLOSE",
)
