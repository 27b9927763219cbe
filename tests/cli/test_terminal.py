# SPDX-License-Identifier: LGPL-2.1-or-later
"""A terminal shows one line of progress, and nothing of it stays; a file gets none."""

import io
import sys

import pytest

from pkm_post.cli.terminal import ProgressLine


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def streams(monkeypatch):
    def of_kind(kind):
        screen = kind()  # both go to one screen, as they do in a terminal
        monkeypatch.setattr(sys, "stdout", screen)
        monkeypatch.setattr(sys, "stderr", screen)
        return screen

    return of_kind


def seen(written):
    """What a terminal shows: a line begins again at a carriage return, and is erased by the sequence behind it."""
    return [line.rpartition("\r\x1b[K")[2] for line in written.getvalue().split("\n")]


def test_line_is_written_over_and_gone_at_the_end(streams):
    screen = streams(Terminal)
    line = ProgressLine("part.ngc")
    line.show("trajectory", 0.0)
    line.show("certificate", 0.5)
    assert seen(screen) == ["part.ngc: certificate 50%"]
    line.print("certificate 0.1 s")
    line.show("report", 0.75)
    assert seen(screen) == ["certificate 0.1 s", "part.ngc: report 75%"]
    line.show("", 1.0)
    assert seen(screen) == ["certificate 0.1 s", ""]


def test_a_file_gets_what_is_printed_and_no_more(streams):
    file = streams(io.StringIO)
    line = ProgressLine("part.ngc")
    line.show("trajectory", 0.0)
    line.print("trajectory 0.1 s")
    line.clear()
    assert file.getvalue() == "trajectory 0.1 s\n"
