# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run pytest with the arguments given, on all cores, and take a run in which no test was executed for a failure.

Each process collects all tests and claims one file after the other, so that none waits while another still has work.
Tests with a window count as two files, so that no more than two windows are open at a time: that of the control panel,
which waits for its simulated machine, and all others. ``PKM_TEST_PROCESSES`` says how many processes there are; by
default one more than cores, since tests with windows and links wait most of their time. Inside FreeCAD (``make test``)
this is run by run_script.py.
"""

import mmap
import os
import struct
import sys
import tempfile
from contextlib import suppress
from itertools import groupby
from pathlib import Path

import pytest

WITH_A_WINDOW = "freecad_gui"
CONTROL_PANEL = "test_gui_control"
_MOST_PROCESSES = 4


class ExecutedTests:
    """A pytest plug-in that counts tests that ran; one that was skipped did not."""

    def __init__(self):
        self.count = 0

    def pytest_runtest_logreport(self, report):
        """Count the test proper, without its preparation and its tidying up."""
        if report.when == "call" and not report.skipped:
            self.count += 1

    def pytest_sessionfinish(self, session, exitstatus):
        """Change the exit code of a run that would be called a success."""
        if exitstatus == pytest.ExitCode.OK and not self.count and not session.config.option.collectonly:
            session.exitstatus = pytest.ExitCode.NO_TESTS_COLLECTED


class NextFile:
    """The number of the next file that no process has claimed; processes that were forked share it."""

    def __init__(self):
        self._shared = mmap.mmap(-1, 8)
        self._lock = tempfile.TemporaryFile()  # noqa: SIM115 - it lasts as long as the run

    def claim(self):
        """Claim a file; its number."""
        import fcntl

        fcntl.lockf(self._lock, fcntl.LOCK_EX)
        try:
            number = struct.unpack("q", self._shared[:])[0]
            self._shared[:] = struct.pack("q", number + 1)
            return number
        finally:
            fcntl.lockf(self._lock, fcntl.LOCK_UN)


class ClaimedFiles:
    """A pytest plug-in that runs the tests of those files that this process claims."""

    def __init__(self, next_file):
        self._next_file, self.has_claimed = next_file, False

    def pytest_runtestloop(self, session):
        """Take the place of pytest's own loop, but for runs that execute nothing."""
        if session.testsfailed or session.config.option.collectonly:
            return None
        claimed = self._claimed(_by_file(session.items))
        item = next(claimed, None)
        while item is not None:
            following = next(claimed, None)
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if session.shouldfail:
                raise session.Failed(session.shouldfail)
            if session.shouldstop:
                raise session.Interrupted(session.shouldstop)
            item = following
        return True

    def _claimed(self, files):
        while (number := self._next_file.claim()) < len(files):
            self.has_claimed = True
            yield from files[number]


def _by_file(items):
    """The tests of each file, those with a window first."""
    return [list(group) for _, group in groupby(sorted(items, key=_file_of), _file_of)]


def _file_of(item):
    """What is claimed as one file."""
    if WITH_A_WINDOW not in item.path.parts:
        return 1, str(item.path)
    return 0, CONTROL_PANEL if item.path.stem == CONTROL_PANEL else WITH_A_WINDOW


def in_processes(count, arguments):
    """Run pytest in so many processes; the exit codes. The first prints as it goes, the others when they have ended."""
    next_file = NextFile()
    sys.stdout.flush()
    with tempfile.TemporaryDirectory() as folder:
        printed = [Path(folder) / str(number) for number in range(1, count)]
        children = [_fork(arguments, next_file, path) for path in [None, *printed]]
        codes = [_exit_code_of(child) for child in children]
        for path in printed:
            print(path.read_text(encoding="utf-8"), end="", flush=True)
    return codes


def _fork(arguments, next_file, printed):
    """Start a process that runs pytest and prints to a file, if one is given."""
    child = os.fork()
    if not child:
        if printed:
            sys.stdout = printed.open("w", encoding="utf-8")
        code, files = 1, ClaimedFiles(next_file)
        try:
            code = int(pytest.main(list(arguments), plugins=[ExecutedTests(), files]))
        finally:
            sys.stdout.flush()
            if printed and code == pytest.ExitCode.NO_TESTS_COLLECTED and not files.has_claimed:
                sys.stdout.truncate(0)  # the last line of all is that of a run
            os._exit(code)  # the parent tidies up
    return child


def _exit_code_of(child):
    while True:
        with suppress(KeyboardInterrupt):  # the child has it as well
            return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) & 0xFF


def _combined(codes):
    """One exit code: a failure, if there is one; a process may find no file left to claim."""
    nothing = int(pytest.ExitCode.NO_TESTS_COLLECTED)
    faults = [code for code in codes if code not in (0, nothing)]
    return faults[0] if faults else min(codes)


def _processes():
    if not hasattr(os, "fork"):
        return 1
    return int(os.environ.get("PKM_TEST_PROCESSES") or min((os.cpu_count() or 1) + 1, _MOST_PROCESSES))


if __name__ == "__main__":
    if (count := _processes()) > 1:
        exit_code = _combined(in_processes(count, sys.argv[1:]))
    else:
        exit_code = int(pytest.main(sys.argv[1:], plugins=[ExecutedTests()]))
    if exit_code == pytest.ExitCode.NO_TESTS_COLLECTED:
        print("No test was executed: this is a failure.", file=sys.stderr)
    sys.exit(exit_code)
