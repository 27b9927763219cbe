# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frozen dataclasses of the model are those of the standard library, made in less time."""

import copy
import dataclasses
import pickle

import pytest

from pkm_post.model.record import dataclass


def of_both_kinds(make):
    """The same class by the decorator of the library, and by ours."""
    return pytest.mark.parametrize("made", [make(dataclasses.dataclass), make(dataclass)], ids=["library", "ours"])


@dataclass(frozen=True)
class Place:
    """Can be pickled, since it is a name of the module."""

    file: str
    line: int = 1


def place(decorator):
    @decorator(frozen=True)
    class Point:
        file: str
        line: int = 1
        names: dict = dataclasses.field(default_factory=dict, compare=False, repr=False)

        def __post_init__(self):
            object.__setattr__(self, "line", self.line + 1)

    return Point


@of_both_kinds(place)
def test_instances_are_made_shown_compared_and_hashed_as_by_the_library(made):
    first, same, other = made("a.ngc", 3, {"a": 1}), made("a.ngc", line=3), made("a.ngc")
    assert repr(first).endswith("Point(file='a.ngc', line=4)")
    assert first == same and hash(first) == hash(same) and first != other and first != ("a.ngc", 4)
    assert dataclasses.replace(other, file="b.ngc") == made("b.ngc", 2)
    assert [field.name for field in dataclasses.fields(made)] == ["file", "line", "names"]
    assert dataclasses.asdict(other) == {"file": "a.ngc", "line": 2, "names": {}}
    assert {first: "found"}[same] == "found"


@of_both_kinds(place)
@pytest.mark.parametrize("name", ["line", "names", "unknown"])
def test_attributes_cannot_be_set_or_deleted(made, name):
    one = made("a.ngc")
    with pytest.raises(dataclasses.FrozenInstanceError, match=name):
        setattr(one, name, 5)
    with pytest.raises(dataclasses.FrozenInstanceError, match=name):
        delattr(one, name)
    assert one == made("a.ngc")


def with_own_text(decorator):
    @decorator(frozen=True)
    class Named:
        name: str

        def __repr__(self):
            return self.name

        def __eq__(self, other):
            return self.name.lower() == other.name.lower()

        def __hash__(self):
            return hash(self.name.lower())

    return Named


@of_both_kinds(with_own_text)
def test_methods_of_the_class_itself_stay(made):
    assert repr(made("Tool")) == "Tool"
    assert made("Tool") == made("TOOL") and len({made("Tool"), made("TOOL")}) == 1


def derived(decorator):
    @decorator(frozen=True)
    class Base:
        first: int

    @decorator(frozen=True, kw_only=True)
    class Derived(Base):
        second: int = 2

    return Base, Derived


@of_both_kinds(derived)
def test_a_derived_class_has_the_fields_of_its_base_and_is_not_equal_to_it(made):
    base, wider = made
    assert wider(1) == wider(1, second=2) != wider(1, second=3)
    assert base(1) != wider(1) and wider(1) != base(1)
    with pytest.raises(TypeError):
        wider(1, 2)


def test_what_is_not_plainly_frozen_is_made_by_the_library():
    @dataclass
    class Open:
        value: int

    @dataclass(frozen=True, eq=False)
    class Same:
        value: int

    one = Open(1)
    one.value = 2
    assert one == Open(2) and Same(1) != Same(1)


def test_copies_and_pickled_ones_are_equal():
    one = Place("a.ngc", 7)
    assert copy.copy(one) == copy.deepcopy(one) == pickle.loads(pickle.dumps(one)) == one
