# SPDX-License-Identifier: LGPL-2.1-or-later
"""Presets are found by name, other machine files by path."""

from pathlib import Path

import pytest

from pkm_post.machine_file import find_machine, presets, read_machine


def test_example_machine_is_a_preset():
    assert "example_6tps" in presets()
    assert presets() == sorted(presets())


@pytest.mark.parametrize("name", presets())
def test_every_preset_reads_without_fault(name):
    machine, diagnostics = read_machine(find_machine(name))
    assert diagnostics == ()
    assert machine is not None


@pytest.mark.parametrize("path", ["here.toml", "machines/here", "C:\\machines\\here", "./example_6tps"])
def test_path_is_used_as_it_is(path):
    assert find_machine(path) == Path(path)


@pytest.mark.parametrize("name", ["unknown", "", "*", "EXAMPLE_6TPS", ".."])
def test_unknown_name_finds_nothing(name):
    assert find_machine(name) is None
