# SPDX-License-Identifier: LGPL-2.1-or-later
"""A tool becomes the corner circle of its cutter."""

import dataclasses
import math

import pytest

from pkm_post.compensation import Cutter
from pkm_post.model import Tool


def tool(diameter, corner_radius):
    return Tool(number=3, name="cutter", diameter=diameter, corner_radius=corner_radius, length=100.0)


@pytest.mark.parametrize(
    ("diameter", "corner_radius", "corner"),
    [
        # APT cutters (d, r, e, f) worked by hand: CUTTER/10,5,0,5; CUTTER/10,0,5,0; CUTTER/20,4,6,4
        (10.0, 5.0, Cutter(5.0, 0.0, 5.0)),
        (10.0, 0.0, Cutter(0.0, 5.0, 0.0)),
        (20.0, 4.0, Cutter(4.0, 6.0, 4.0)),
    ],
    ids=["ball", "flat", "bull nose"],
)
def test_corner_of_a_tool(diameter, corner_radius, corner):
    assert Cutter.of(tool(diameter, corner_radius)) == corner


@pytest.mark.parametrize("diameter", [0.0, -10.0, math.nan, math.inf])
def test_unknown_or_senseless_diameter_is_the_callers_fault(diameter):
    with pytest.raises(ValueError, match=r"tool 3: expected a diameter above 0 mm, got"):
        Cutter.of(tool(diameter, 0.0))


@pytest.mark.parametrize("corner_radius", [-0.1, 5.001, math.nan])
def test_corner_that_does_not_fit_the_diameter_is_the_callers_fault(corner_radius):
    with pytest.raises(ValueError, match=r"tool 3: expected a corner radius from 0 to 5.0 mm, got"):
        Cutter.of(tool(10.0, corner_radius))


@pytest.mark.parametrize("sizes", [(-1.0, 5.0, 0.0), (1.0, -5.0, 1.0), (1.0, 5.0, math.nan), (0.0, 0.0, 0.0)])
def test_corner_without_extent_or_with_negative_sizes_is_refused(sizes):
    with pytest.raises(ValueError, match="expected"):
        Cutter(*sizes)


def test_a_cutter_cannot_change():
    with pytest.raises(dataclasses.FrozenInstanceError):
        Cutter(4.0, 6.0, 4.0).corner_radius = 5.0
