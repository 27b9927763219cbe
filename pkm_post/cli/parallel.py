# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel: several commands at a time, each in its own process.

Their output is printed in order, not interleaved. Ctrl-C ends them all, as does the end of this process by a signal.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from pkm_post.cli import terminal
from pkm_post.cli.processes import INTERRUPTED, TIME_TO_END, outcome, start_fault
from pkm_post.cli.terminal import ProgressLine
from pkm_post.system import thread_share

_HAS_GROUPS = os.name == "posix"
"""Whether a process can lead a process group, so that all its children end with it."""


@dataclass
class Child:
    """A process of the command line that posts a file.

    Attributes:
        leads: whether Ctrl-C does not reach it, but ``interrupt`` does.
    """

    command: Sequence[str]
    variables: Mapping[str, str]
    process: subprocess.Popen[str] | None = None
    is_wanted: bool = True
    file: str = ""
    leads: bool = True

    def run(self) -> tuple[int, str, str]:
        """Run it and return exit code, output and errors."""
        if not self.is_wanted:
            return 1, "", ""
        try:
            self.process = self._start()
        except OSError as fault:
            return 1, "", f"{start_fault(self.command, fault, self.file)}\n"
        if not self.is_wanted:
            self.interrupt()
        with terminal.ended_with_us(self.process):
            printed, errors = self.process.communicate()
        code, fault_text = outcome(self.command, self.process.returncode, self.file)
        return code, printed, f"{errors}{fault_text}\n" if fault_text else errors

    def _start(self) -> subprocess.Popen[str]:
        return subprocess.Popen(
            self.command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="replace",
            env=os.environ | self.variables | {"PYTHONIOENCODING": "utf-8"},  # independent of the locale
            start_new_session=self.leads and _HAS_GROUPS,
            creationflags=terminal.flags_by_us() if self.leads else terminal.flags_with_us(),
        )

    def interrupt(self) -> None:
        """Interrupt it, so that it cleans up."""
        self.is_wanted = False
        if self.process is None or self.process.poll() is not None:
            return
        if _HAS_GROUPS:
            self._signal(signal.SIGTERM)  # a shell without a terminal lets its jobs ignore SIGINT
        elif terminal.BREAK is not None and terminal.has_console():
            self.process.send_signal(terminal.BREAK)
        else:
            self.process.terminate()

    def end(self) -> None:
        """Wait for its end, with a timeout."""
        if self.process is not None:
            try:
                self.process.wait(TIME_TO_END)
            except subprocess.TimeoutExpired:
                self._signal(signal.SIGKILL) if _HAS_GROUPS else self.process.kill()

    def _signal(self, number: int) -> None:
        if self.process is not None:
            with contextlib.suppress(ProcessLookupError):  # it has already ended
                os.killpg(self.process.pid, number)


def run_parallel(
    commands: Sequence[Sequence[str]], at_a_time: int, doing: str, files: Sequence[str] | None = None
) -> int:
    """Run commands; return 0 if all succeeded, 130 after Ctrl-C, and 1 otherwise.

    Args:
        at_a_time: most parallel processes.
        doing: task shown in the terminal.
        files: what each of them posts.
    """
    shared, named = thread_share(at_a_time), files or [""] * len(commands)
    children = [Child(command, shared, file=file) for command, file in zip(commands, named, strict=True)]
    line, code = ProgressLine(doing), 0
    with ThreadPoolExecutor(at_a_time) as pool:
        try:
            for number, (ended, printed, errors) in enumerate(pool.map(Child.run, children)):
                line.clear()
                print(printed, end="", flush=True)
                print(errors, end="", file=sys.stderr, flush=True)
                code = code or int(ended != 0)
                line.show(f"{number + 1} of {len(children)}", (number + 1) / len(children))
        except BaseException as fault:
            _end_all(children)
            if not isinstance(fault, KeyboardInterrupt):
                raise
            code = INTERRUPTED
        finally:
            line.clear()
    return code


def _end_all(children: Sequence[Child]) -> None:
    for child in children:
        child.interrupt()
    for child in children:
        child.end()
