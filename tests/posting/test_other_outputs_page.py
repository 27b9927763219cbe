# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tables on the page of other outputs are those of the block of the journey, as its commands write them."""

import re
from pathlib import Path

import pytest

from pkm_post.cli import main
from pkm_post.machine import find_machine

DOCS = Path(__file__).parents[2] / "docs"


def blocks(page, kind=""):
    return re.findall(rf"^```{kind}\n(.*?)^```", (DOCS / page).read_text(encoding="utf-8"), re.M | re.S)


@pytest.mark.slow
def test_tables_of_the_page_are_what_its_commands_write(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("machine.toml").write_bytes(find_machine("example_6tps").read_bytes())
    Path("part.ngc").write_text(blocks("journey.md", "gcode")[0], encoding="ascii")
    words = "post part.ngc --machine machine.toml --tool-length 1=120 --also csv,halstreamer --axis-words vector"
    assert main(words.split()) == 0, capsys.readouterr()
    streamed, table = blocks("other-outputs.md")
    assert Path("part-halstreamer.txt").read_text(encoding="ascii").startswith(streamed)
    assert Path("part.csv").read_text(encoding="ascii").splitlines()[1:3] == table.splitlines()[1:]
