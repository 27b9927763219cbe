# SPDX-License-Identifier: LGPL-2.1-or-later
"""Phrases: texts that keep pattern and values, and are their English text for everything else."""

import copy
import json
import pickle

import pytest

from pkm_post.model import Amount, Diagnostic, Pattern, Phrase, Place


def test_phrase_is_its_english_text():
    made = Phrase("strut {part} by {by}", part=3, by=Amount(1.25, "mm", ".3f"))
    assert made == "strut 3 by 1.250 mm"
    assert f"{made}!" == "strut 3 by 1.250 mm!"
    assert json.dumps([made]) == '["strut 3 by 1.250 mm"]'
    assert {made: 1}["strut 3 by 1.250 mm"] == 1
    assert str(Diagnostic("K102", Place("a.nc", line=2), made)).startswith("a.nc: line 2: error K102: a strut")


def test_phrase_keeps_what_it_was_made_of():
    inner = Phrase("shank of {}", "T1")
    made = Pattern("{}, {name}").phrase(inner, name="x")
    assert (made, made.pattern, made.values, made.named) == ("shank of T1, x", "{}, {name}", (inner,), {"name": "x"})
    assert made.values[0].pattern == "shank of {}"


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda each: pickle.loads(pickle.dumps(each))])
def test_phrase_survives_copies_and_other_processes(copied):
    made = Phrase("{{{}}} of {most}", Amount(2.0, "um"), most=Phrase("part"))
    again = copied(made)
    assert (again, again.pattern, again.values, again.named) == (made, made.pattern, made.values, made.named)
    assert isinstance(again.named["most"], Phrase)


def test_amount_without_unit_is_its_number():
    assert [str(Amount(0.25, "", ".4f")), str(Amount(12345.678, "mm"))] == ["0.2500", "1.235e+04 mm"]


def test_pattern_and_values_have_to_fit():
    with pytest.raises(IndexError):
        Phrase("{} and {}", 1)
