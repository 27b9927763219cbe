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
def traced(call: Callable[[CodeType], object]) -> Iterator[None]:
    """Have ``call`` look at each function of PKM Post when this thread enters it."""

    def trace(frame: FrameType, event: str, _: object) -> None:
        if event == "call" and frame.f_code.co_filename.startswith(PACKAGE):
            call(frame.f_code)

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

    def raise_there(code: CodeType) -> None:
        nonlocal entered
        if place.endswith(code.co_qualname) and place_of(code) == place:
            entered += 1
            if entered == call + 1:
                met.append(place)
                raise MemoryError(WHAT)

    with traced(raise_there):
        yield met
