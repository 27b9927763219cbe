# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ends: check by its last statement that a file is complete.

Enters: the statements of a file. Leaves: a fault if the end is missing. FINI ends CL data. CLSF of NX has no FINI: each
of its tool paths ends with END-OF-PATH; and APT-CL of Makino ends with a section for the end of its process. No
meaningful statement may follow. A file without an end may be truncated.
"""

from __future__ import annotations

import re
from collections.abc import Collection

from pkm_post.reading.cldata.course import Course

_ENDS = re.compile(r"\s*(?:END-OF-PATH|PPRINT\s*/\s*END-SECTION\s*,\s*PROCESS-END-PATH)\s*", re.IGNORECASE)


def tell_open_end(course: Course, passed_over: Collection[str]) -> None:
    """Report a missing end where one is required.

    Args:
        course: with all statements read.
        passed_over: words without effect on the motion.
    """
    needs_one = course.options.needs_end and not course.ended and len(course.statements)
    if needs_one and not _is_closed(course, passed_over):
        course.tell("L441", len(course.statements) - 1, "no FINI or END-OF-PATH behind it")


def _is_closed(course: Course, passed_over: Collection[str]) -> bool:
    """Whether only words without effect follow a statement that ends a file."""
    statements = course.statements
    for row in reversed(range(len(statements))):
        if _ENDS.fullmatch(statements.lines.text[statements.index[row]]):
            return True
        if statements.word(row) not in passed_over:
            return False
    return False
