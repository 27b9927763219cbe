# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``pmac play`` with a simulated controller that serves: a posted trajectory, orders, a line."""

import copy
import io
from dataclasses import replace

import pytest
from playing import TOOL
from rig import served
from station import MACHINE, set_up

from pkm_post.cli import main
from pkm_post.cli.pmac_play import order_of
from pkm_post.control.player.playable import first_row, read_playable
from pkm_post.posting.post_file import post_file

SOURCE = "G21 G90 G54\nG0 X0 Y0 Z100\nS1000 M3\nG1 X20 F6000\nG1 Y10\nM30\n"
NAME = "example_6tps"


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("posted")
    (folder / "part.ngc").write_text(SOURCE)
    post_file(folder / "part.ngc", NAME, folder, tool_lengths={0: TOOL})
    return folder / "part.pkmt"


def play(port, file, *arguments):
    return main(["pmac", "play", str(file), "--port", port, "--machine", NAME, "--patience", "10", *arguments])


@pytest.mark.parametrize("kind", ["tcp", "serial"])
def test_a_trajectory_is_played_over_a_link(kind, posted, capsys, monkeypatch):
    made = copy.deepcopy(set_up())
    monkeypatch.setattr("sys.stdin", io.StringIO("override 140\nfaster\n"))
    with served(made, kind) as port:
        assert play(port, posted, *(["--from-line", "5"] if kind == "serial" else [])) == (kind == "serial")
        shown = capsys.readouterr()
        if kind == "serial":  # no one has said that the tool is in the spindle
            assert (
                "waits: T0, 120 mm long, in the spindle, line 5" in shown.out and "ended by the operator" in shown.out
            )
            return
        assert "the program has ended" in shown.out and "deviation of the tool tip: 0.000" in shown.out
        assert "expected one of override PERCENT" in shown.err
    assert made.systems[0].path.abrupt_stops == 0 and not made.runs_program()
    assert made.variables.read("P", 7001) == 0  # M30 has stopped the spindle


def test_what_cannot_be_played_is_refused(posted, tmp_path):
    trajectory, tolerances, faults = read_playable(posted, MACHINE)
    assert not faults and tolerances == trajectory.tolerances
    assert first_row(trajectory, 5, "", posted)[0] == len(trajectory) - 1
    row, faults = first_row(trajectory, 99, "", posted)
    assert row is None and [each.code for each in faults] == ["C207"]
    _, _, faults = read_playable(posted, replace(MACHINE, tip_jerk=1e5))
    assert [each.code for each in faults] == ["C206"]
    _, _, faults = read_playable(posted, replace(MACHINE, fingerprint="0" * 64))
    assert [each.code for each in faults] == ["T104"]


def test_orders_of_an_operator():
    assert order_of("Override 120\n") == ("override", 1.2)
    assert order_of("single on") == ("single", 1.0)
    assert order_of("end\n") == ("end", 0.0)
    for line in ("override 151", "override -1", "override", "single", "hold now", "", "stop"):
        assert order_of(line) is None
