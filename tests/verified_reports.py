# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the report of ``verify`` says of a program what posting said of it.

Posting names the moment at which its plan passes each joint, ``verify`` that at which the tool fits it best: figures of
deviations differ by a part of what is allowed, all others by rounding.
"""

import math

PART_OF_LIMIT = 0.2
ROUNDING = 1e-3
LIKE_PLANNED = ("format", "program", "machine", "files", "tolerances", "motion")
NOT_KNOWN = {"coverage", "meaning"}
"""The files do not have part and stock: what was looked for with them is not known to ``verify``."""


def agree(verified, posted):
    """Assert that the two reports do."""
    assert verified.keys() == posted.keys()
    assert all(verified[name] == posted[name] for name in LIKE_PLANNED)
    assert math.isclose(verified["machining_time"]["total_s"], posted["machining_time"]["total_s"], abs_tol=2e-3)
    certificates_agree(verified["certificate"], posted["certificate"])


def certificates_agree(verified, posted):
    """Assert that the certificates do."""
    assert verified["holds"] is posted["holds"] is True
    assert len(verified["findings"]) == len(posted["findings"])
    for one, other in zip(verified["findings"], posted["findings"], strict=True):
        assert all(one[name] == other[name] for name in ("what", "unit", "limit", "is_least", "holds"))
        apart = max(PART_OF_LIMIT * one["limit"], ROUNDING * abs(other["value"]))
        assert math.isclose(one["value"], other["value"], abs_tol=apart), one["what"]
