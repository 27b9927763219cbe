# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ends: whether a file is whole, by its last statement.

The statements of a file enter. FINI ends CL data. CLSF of NX has no FINI: each of its tool paths ends with END-OF-PATH;
and APT-CL of Makino ends with a section for the end of its process. Behind such a statement nothing may stand that
means anything. A file without one may have been cut short.
"""

from __future__ import annotations

import re
from collections.abc import Collection

from pkm_post.cldata.course import Course

_ENDS = re.compile(r"\s*(?:END-OF-PATH|PPRINT\s*/\s*END-SECTION\s*,\s*PROCESS-END-PATH)\s*", re.IGNORECASE)


def tell_open_end(course: Course, passed_over: Collection[str]) -> None:
    """Tell that a file has no end, where it needs one.

    Args:
        course: all of its statements read.
        passed_over: words that say nothing of the motion.
    """
    needs_one = course.options.needs_end and not course.ended and len(course.statements)
    if needs_one and not _is_closed(course, passed_over):
        course.tell("L441", len(course.statements) - 1, "no FINI or END-OF-PATH behind it")


def _is_closed(course: Course, passed_over: Collection[str]) -> bool:
    """Whether nothing but words without a meaning stands behind a statement that ends a file."""
    statements = course.statements
    for row in reversed(range(len(statements))):
        if _ENDS.fullmatch(statements.lines.text[statements.index[row]]):
            return True
        if statements.word(row) not in passed_over:
            return False
    return False
