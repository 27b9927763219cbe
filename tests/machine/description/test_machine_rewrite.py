# SPDX-License-Identifier: LGPL-2.1-or-later
"""Entries of machine files are replaced, and every other line stays as it was."""

import difflib

import numpy as np
import pytest

from pkm_post.machine.description.presets import find_machine, presets
from pkm_post.machine.description.reader import machine_of, read_machine
from pkm_post.machine.description.rewrite import CannotRewriteError, with_entries

NANOMETRE = 1.01e-6
EXAMPLE = find_machine("example_6tps").read_text(encoding="utf-8")


def entries(seed=1):
    rng = np.random.default_rng(seed)
    machine, _ = read_machine(find_machine("example_6tps"))
    return {
        "base.joints": machine.base_joints + rng.normal(0, 1, (6, 3)),
        "platform.joints": machine.platform_joints + rng.normal(0, 1, (6, 3)),
        "struts.length_offset": rng.normal(0, 1, 6),
    }


def joints(machine):
    return dict(zip(entries(), (machine.base_joints, machine.platform_joints, machine.length_offset), strict=True))


def assert_holds(text, wanted):
    machine, faults = machine_of(text.encode(), "new.toml")
    assert faults == ()
    for entry, found in joints(machine).items():
        np.testing.assert_allclose(found, wanted[entry], atol=NANOMETRE, rtol=0)


def test_new_numbers_are_read_again():
    assert_holds(with_entries(EXAMPLE, entries()), entries())


def test_all_other_lines_stay():
    changed = with_entries(EXAMPLE, entries())
    matcher = difflib.SequenceMatcher(None, EXAMPLE.split("\n"), changed.split("\n"), autojunk=False)
    changes = [EXAMPLE.split("\n")[a:b] for tag, a, b, *_ in matcher.get_opcodes() if tag != "equal"]
    assert changes[0][0] == "    [586.8886, 124.7470, 1400.0],"
    assert sum(map(len, changes)) == 12  # six base joints, six platform joints; the offsets are a new line
    assert with_entries(changed, entries()) == changed


@pytest.mark.parametrize("name", presets())
def test_every_preset_can_be_rewritten(name):
    path = find_machine(name)
    machine, _ = read_machine(path)
    again, faults = machine_of(with_entries(path.read_text(encoding="utf-8"), joints(machine)).encode(), "new.toml")
    assert faults == ()
    for entry, found in joints(again).items():
        np.testing.assert_allclose(found, joints(machine)[entry], atol=25.4 * NANOMETRE, rtol=0)


def test_keys_with_dots_and_comments_are_replaced_in_their_line():
    text = EXAMPLE.replace("[struts]\n", "[struts]\n  length_offset = [1, 2, 3,\n 4, 5, 6]  # of last year\n")
    changed = with_entries(text, {"struts.length_offset": np.zeros(6)})
    assert (
        "\n  length_offset = [0.000000, 0.000000, 0.000000, 0.000000, 0.000000, 0.000000]  # of last year\n" in changed
    )
    start, end = EXAMPLE.index("[base]"), EXAMPLE.index("spindle_nose")
    dotted = "base.joints = " + EXAMPLE[start:end].split("= ", 1)[1].split("]\n\n")[0] + "]\n"
    text = EXAMPLE[:start].replace("[units]", dotted + "[units]") + EXAMPLE[EXAMPLE.index("# Platform:") :]
    assert_holds(with_entries(text, entries()), entries())


@pytest.mark.parametrize(
    "text",
    [
        "units = { length = 'mm' }\nbase = { joints = 0 }\n",
        "units = { length = 'mm' }\nbase.other = 0\n",
        "units = { length = 'mm' }\n",
    ],
)
def test_entries_that_do_not_start_a_line_are_refused(text):
    with pytest.raises(CannotRewriteError, match="base"):
        with_entries(text, {"base.joints": np.zeros((6, 3))})
