# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run pytest with the arguments given, and take a run in which no test was executed for a failure.

Inside FreeCAD (``make test``) this is run by run_script.py.
"""

import sys

import pytest


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


if __name__ == "__main__":
    exit_code = pytest.main(sys.argv[1:], plugins=[ExecutedTests()])
    if exit_code == pytest.ExitCode.NO_TESTS_COLLECTED:
        print("No test was executed: this is a failure.", file=sys.stderr)
    sys.exit(int(exit_code))
