# SPDX-License-Identifier: LGPL-2.1-or-later
"""Free words: the controller's free memory, whose sign indicates an open program buffer."""

from __future__ import annotations

from pkm_post.control.link.faults import LinkLostError
from pkm_post.control.link.session import Session


def free_words(session: Session) -> int:
    """Words of free memory; negative while a buffer is open.

    Raises:
        LinkLostError: the answer makes no sense.
    """
    (told,) = session.ask("SIZE")[:1] or ("",)
    try:
        return int(told)
    except ValueError:
        raise LinkLostError(f"SIZE: expected a number of words, got {told!r}") from None
