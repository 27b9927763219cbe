# SPDX-License-Identifier: LGPL-2.1-or-later
"""A lack of memory, made: a call of one function of PKM Post raises MemoryError, whatever it was called for."""

import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import CodeType, FrameType

import pkm_post

PACKAGE = os.path.dirname(pkm_post.__file__)
WHAT = "Unable to allocate 7 GiB"


@contextmanager
def traced(call: Callable[[CodeType], bool]) -> Iterator[None]:
    """Have ``call`` look at functions of PKM Post when this thread enters them, again if it says so."""
    with _monitored(call) if hasattr(sys, "monitoring") else _by_calls(call):
        yield


@contextmanager
def _monitored(call: Callable[[CodeType], bool]) -> Iterator[None]:
    """From Python 3.12 on: what was looked at runs as fast as ever."""
    monitoring, thread = sys.monitoring, threading.get_ident()
    tool, events = monitoring.PROFILER_ID, monitoring.events

    def enter(code: CodeType, _: int) -> object:
        if not code.co_filename.startswith(PACKAGE):
            return monitoring.DISABLE
        if threading.get_ident() != thread:
            return None
        return None if call(code) else monitoring.DISABLE

    monitoring.use_tool_id(tool, __name__)
    try:
        for event in (events.PY_START, events.PY_RESUME):
            monitoring.register_callback(tool, event, enter)
        monitoring.set_events(tool, events.PY_START | events.PY_RESUME)
        monitoring.restart_events()
        yield
    finally:
        monitoring.free_tool_id(tool)


@contextmanager
def _by_calls(call: Callable[[CodeType], bool]) -> Iterator[None]:
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
