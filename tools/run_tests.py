# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run pytest with the arguments given, on all cores, and take a run in which no test was executed for a failure.

pytest collects all tests once. Processes forked from it claim one file after the other, so that none waits while
another still has work, and send their reports to the first one, which prints one result for all. Tests with a window
count as two files, so that no more than two windows are open at a time: that of the control panel, which waits for its
simulated machine, and all others. ``PKM_TEST_PROCESSES`` says how many processes there are; by default one more than
cores, since tests with windows and links wait most of their time. Inside FreeCAD (``make test``) this is run by
run_script.py.
"""

import json
import mmap
import os
import selectors
import struct
import sys
import tempfile
import traceback
from itertools import groupby

import pytest

WITH_A_WINDOW = "freecad_gui"
CONTROL_PANEL = "test_gui_control"
_MOST_PROCESSES = 4
_THREADS = "/proc/self/task"
"""Where Linux lists the threads of a process."""
_NO_MORE = 1 << 60
"""A number of a file that stops all processes."""


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
        return self._replace(lambda number: number + 1)

    def stop(self):
        """Let no process claim another file or begin another test."""
        self._replace(lambda number: _NO_MORE)

    @property
    def is_stopped(self):
        """Whether no other test is to begin."""
        return struct.unpack("q", self._shared[:])[0] >= _NO_MORE

    def _replace(self, following):
        """Put another number in the place of the one that is there, which is returned."""
        import fcntl

        fcntl.lockf(self._lock, fcntl.LOCK_EX)
        try:
            number = struct.unpack("q", self._shared[:])[0]
            self._shared[:] = struct.pack("q", following(number))
            return number
        finally:
            fcntl.lockf(self._lock, fcntl.LOCK_UN)


class ForkedRun:
    """A pytest plug-in that runs the collected tests in forked processes, and reports what they report.

    Args:
        count: how many processes.
    """

    def __init__(self, count):
        self._count, self._next_file = count, NextFile()

    def pytest_runtestloop(self, session):
        """Take the place of pytest's own loop, but for runs that execute nothing."""
        if session.testsfailed or session.config.option.collectonly or not session.items:
            return None
        _require_one_thread()
        workers = [Worker(session, self._next_file) for _ in range(min(self._count, len(session.items)))]
        try:
            self._report(session, workers)
        finally:
            self._next_file.stop()
            for worker in workers:
                worker.wait()
        return True

    def _report(self, session, workers):
        """Pass on what the processes report, until all have ended."""
        with selectors.DefaultSelector() as selector:
            for worker in workers:
                selector.register(worker.output, selectors.EVENT_READ, worker)
            while selector.get_map():
                for key, _ in selector.select():
                    for report in key.data.reports(session.config.hook, session.config):
                        session.config.hook.pytest_runtest_logreport(report=report)
                    if key.data.has_ended:
                        selector.unregister(key.fileobj)
                if reason := session.shouldfail or session.shouldstop:
                    self._next_file.stop()
                    raise (session.Failed if session.shouldfail else session.Interrupted)(reason)


def _require_one_thread():
    """Refuse to fork beside other threads: a lock that one of them holds is never released in the forked process."""
    if os.path.isdir(_THREADS) and len(os.listdir(_THREADS)) > 1:
        raise pytest.UsageError("a test module starts threads when it is imported, as shapes computed there do")


class Worker:
    """A forked process that runs the tests of those files that it claims.

    Attributes:
        output: file descriptor of what it reports, a line of JSON for the beginning of a test and for each report.
        has_ended: whether it has closed its output.
    """

    def __init__(self, session, next_file):
        self.output, there = os.pipe()
        self.has_ended, self._rest, self._test, self._status = False, b"", None, None
        sys.stdout.flush()
        sys.stderr.flush()
        self._process = os.fork()
        if not self._process:
            os.close(self.output)
            _run_claimed(session, next_file, os.fdopen(there, "w", encoding="utf-8"))
        os.close(there)

    def reports(self, hook, config):
        """The reports that arrived; of the test in which the process died, a report of that."""
        received = os.read(self.output, 1 << 16)
        *lines, self._rest = (self._rest + received).split(b"\n")
        for line in map(json.loads, lines):
            if isinstance(line, dict):
                yield hook.pytest_report_from_serializable(config=config, data=line)
            else:
                self._test = line
        if not received:
            self.has_ended = True
            if code := self.wait():
                yield self._report_of_death(code)

    def wait(self):
        """Wait for the end of the process; 0, its exit code, or the number of the signal below 0."""
        if self._status is None:
            self._status = os.waitstatus_to_exitcode(os.waitpid(self._process, 0)[1])
            os.close(self.output)
        return self._status

    def _report_of_death(self, code):
        nodeid, location = self._test or ("", ("", None, ""))
        died = f"The process of this test died: {f'signal {-code}' if code < 0 else f'exit code {code}'}."
        return pytest.TestReport(nodeid, tuple(location), {}, "failed", died, "call")


class Reports:
    """A pytest plug-in that writes each report as a line of JSON."""

    def __init__(self, config, output):
        self._config, self._output = config, output

    def pytest_runtest_logstart(self, nodeid, location):
        """Say which test begins, for the case that it does not end."""
        self._write([nodeid, location])

    def pytest_runtest_logreport(self, report):
        """Pass it on to the process that prints."""
        self._write(self._config.hook.pytest_report_to_serializable(config=self._config, report=report))

    def _write(self, line):
        self._output.write(json.dumps(line, default=str) + "\n")
        self._output.flush()


def _run_claimed(session, next_file, output):
    """Run the tests of claimed files in this process, and end it."""
    code, plugins, unread = 1, session.config.pluginmanager, open(os.devnull, "w")  # noqa: SIM115 - until it ends
    try:
        capture = plugins.getplugin("capturemanager")
        capture.stop_global_capturing()  # it is that of the parent, of which the file was inherited
        capture.start_global_capturing()
        session.config.get_terminal_writer()._file = unread  # the parent prints
        plugins.register(Reports(session.config, output))
        _run(session, _claimed(_by_file(session.items), next_file), next_file)
        capture.stop_global_capturing()
        code = 0
    except KeyboardInterrupt:
        code = 130
    except BaseException:
        traceback.print_exc(file=sys.__stderr__)
    finally:
        output.close()
        os._exit(code)  # the parent tidies up


def _run(session, items, next_file):
    """Run tests in the order given."""
    item = next(items, None)
    while item is not None:
        following = next(items, None)
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        if next_file.is_stopped or session.shouldfail or session.shouldstop:
            break
        item = following


def _claimed(files, next_file):
    while (number := next_file.claim()) < len(files):
        yield from files[number]


def _by_file(items):
    """The tests of each file, those with a window first."""
    return [list(group) for _, group in groupby(sorted(items, key=_file_of), _file_of)]


def _file_of(item):
    """What is claimed as one file."""
    if WITH_A_WINDOW not in item.path.parts:
        return 1, str(item.path)
    return 0, CONTROL_PANEL if item.path.stem == CONTROL_PANEL else WITH_A_WINDOW


def _processes():
    if not hasattr(os, "fork"):
        return 1
    return int(os.environ.get("PKM_TEST_PROCESSES") or min((os.cpu_count() or 1) + 1, _MOST_PROCESSES))


if __name__ == "__main__":
    count = _processes()
    exit_code = int(pytest.main(sys.argv[1:], plugins=[ExecutedTests(), *([ForkedRun(count)] if count > 1 else [])]))
    if exit_code == pytest.ExitCode.NO_TESTS_COLLECTED:
        print("No test was executed: this is a failure.", file=sys.stderr)
    used = os.times()
    print(f"{sum(used[:4]) / 60:.1f} minutes of the processor", file=sys.stderr)
    sys.exit(exit_code)
