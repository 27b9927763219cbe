# SPDX-License-Identifier: LGPL-2.1-or-later
"""Typed lengths mean what people mean by them, or nothing; what is shown is read back as it was."""

import FreeCAD as App
import pytest

from pkm_post.freecad_app.gauge_lengths import format_length, parse_length

MILLIMETRES, INCHES = 6, 3
"""Unit schemes of FreeCAD: metric small parts and CNC, imperial decimal."""
ROUNDING = 5e-9
"""Of lengths, relative; they are shown with nine digits."""


@pytest.fixture
def units():
    """Sets the unit scheme, and at the end the one that it was."""
    before = App.ParamGet("User parameter:BaseApp/Preferences/Units").GetInt("UserSchema", 0)
    yield App.Units.setSchema
    App.Units.setSchema(before)


@pytest.mark.parametrize(
    ("text", "mm"),
    [
        ("120", 120), (" 120 mm ", 120), ("12 cm", 120), ("0.12 m", 120), ("3*40 mm", 120), ("120000 µm", 120),
        ("4.5 in", 114.3), ('4.5"', 114.3), ("4' 2\"", 1270), ("118.75", 118.75),
    ],
)  # fmt: skip
def test_length_with_or_without_its_unit(units, text, mm):
    units(MILLIMETRES)
    assert parse_length(text) == pytest.approx(mm, rel=ROUNDING)


def test_number_alone_is_in_the_unit_that_lengths_are_shown_in(units):
    units(INCHES)
    assert parse_length("4.5") == pytest.approx(114.3, rel=ROUNDING)
    assert parse_length("120 mm") == pytest.approx(120, rel=ROUNDING)


@pytest.mark.parametrize(
    "text",
    [
        "", " ", "abc", "0", "0 mm", "-120 mm", "5 deg", "120 mm/s", "120 mm^2", "1/0", "nan", "inf", "1e999 mm",
        "4 1/2 in", "120 mm mm", "12,5 cm", "1,200 mm", "120 毫米", "１２０", "120000 μm",
    ],
)  # fmt: skip
def test_what_is_no_length_above_zero_has_no_meaning(units, text):
    for scheme in (MILLIMETRES, INCHES):
        units(scheme)
        assert parse_length(text) is None


def test_decimal_point_of_the_language_and_the_full_stop():
    assert parse_length("120,5 mm", ",") == pytest.approx(120.5, rel=ROUNDING)
    assert parse_length("120.5 mm", ",") == pytest.approx(120.5, rel=ROUNDING)
    assert parse_length("1.200,5 mm", ",") is None


def test_length_is_shown_in_the_unit_that_is_set(units):
    units(MILLIMETRES)
    assert (format_length(120.0), format_length(118.75125)) == ("120 mm", "118.75125 mm")
    assert format_length(120.5, ",") == "120,5 mm"
    units(INCHES)
    assert format_length(114.3) == "4.5 in"


@pytest.mark.parametrize("point", [".", ","])
def test_what_is_shown_is_read_back_in_every_scheme(units, point):
    for scheme in range(len(App.Units.listSchemas())):
        units(scheme)
        for mm in (0.001234, 7.0, 118.75125, 2540.0):
            assert parse_length(format_length(mm, point), point) == pytest.approx(mm, rel=ROUNDING), scheme
