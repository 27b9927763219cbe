# SPDX-License-Identifier: LGPL-2.1-or-later
"""A lack of memory, made: a call of one function of PKM Post raises MemoryError, whatever it was called for."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import CodeType, FrameType

import pkm_post

PACKAGE = os.path.dirname(pkm_post.__file__)
WHAT = "Unable to allocate 7 GiB"


@contextmanager
def traced(call: Callable[[CodeType], bool]) -> Iterator[None]:
    """Have ``call`` look at functions of PKM Post when this thread enters them, again if it says so."""
    passed: dict[int, CodeType] = {}

    def trace(frame: FrameType, event: str, _: object) -> None:
        code = frame.f_code
        if id(code) not in passed and not (code.co_filename.startswith(PACKAGE) and call(code)):
            passed[id(code)] = code  # its number stays its own

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        yield
    finally:
        sys.settrace(before)


def place_of(code: CodeType) -> str:
    """Module and function, as ``files.staged.staged``."""
    module = code.co_filename.removeprefix(PACKAGE).removesuffix(".py").strip("/").replace("/", ".")
    return f"{module}.{code.co_qualname}"


@contextmanager
def lacking(place: str, call: int = 0) -> Iterator[list[str]]:
    """Let memory run out where a function is entered; the list has its place when it did.

    Args:
        place: of the function, as ``place_of`` has it.
        call: which one of its calls, from 0; a generator is entered each time it goes on.
    """
    met: list[str] = []
    entered = 0

    def raise_there(code: CodeType) -> bool:
        nonlocal entered
        if not place.endswith(code.co_qualname) or place_of(code) != place:
            return False
        entered += 1
        if entered == call + 1:
            met.append(place)
            raise MemoryError(WHAT)
        return True

    with traced(raise_there):
        yield met
