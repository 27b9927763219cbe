# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tables on the page of other outputs are those of the block of the journey, as its commands write them.

The last digits of a plan with limits of jerk depend on the processor and on how NumPy was built, and with them the
milliseconds of its points.
"""

import re
from pathlib import Path

import numpy as np
import pytest

from pkm_post.cli import main
from pkm_post.machine import find_machine

NUMBER = re.compile(r"(?<![\w.])\d+\.\d+")
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
    streamed, table = (page.splitlines() for page in blocks("other-outputs.md"))
    rows = Path("part-halstreamer.txt").read_text(encoding="ascii").splitlines()
    assert_alike(rows[: len(streamed)], streamed)
    _, first, second, *_ = Path("part.csv").read_text(encoding="ascii").splitlines()
    assert_alike([first], table[1:2])
    assert second.count(",") == table[2].count(",")


def assert_alike(lines, expected):
    """The same words, and numbers that differ by less than a tenth of a micrometre."""
    for line, wanted in zip(lines, expected, strict=True):
        assert NUMBER.sub("", line) == NUMBER.sub("", wanted)
        np.testing.assert_allclose(numbers(line), numbers(wanted), atol=1e-4)


def numbers(line):
    return [float(number) for number in NUMBER.findall(line)]
