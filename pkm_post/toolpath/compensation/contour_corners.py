# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contour corners: transitions from the offset of one element of a contour to that of the next. mm.

Takes pairs of elements; returns, as vectors from the programmed corner, where the offset of the first ends and that of
the next begins, and the points to add between them. The radius vector r = d n x t points from the programmed to the
offset point, with n the normal of the plane, t the direction of travel and d the signed offset [paper eq. 10, 11]. The
kind of a transition follows from the turn theta, as (S2 - S1).t = -d sin(theta) for S = r [paper section 5.3]; where
theta is 0 or a half turn, this product is pure rounding, and a threshold decides.

At an inner corner the offset lines or arcs intersect. Of two intersections the one nearest to the programmed corner is
taken, which is the first on the second curve and the last on the first.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, across, cross, dot, norm
from pkm_post.toolpath.compensation.contour_elements import ContourElements, Role
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

SAME = 1e-6
"""mm within which two offset lines coincide."""
NO_TURN = 1e-5
"""Sine of the turn at a corner below which the path continues straight on, or straight back."""
MAX_CORNER_POINTS = 4
"""Most points that a corner adds."""
_RIGHT_ANGLE = 1e-9
"""Cosine of a turn that is a right angle up to rounding: it is extended, not cut off."""
_LEAST_ARC = 0.05
"""Turn in rad up to which offset lines are extended although arcs are selected: they leave the arc by 0.0003 of its
radius, and outward."""


class Transition(enum.IntEnum):
    """Kinds of corners."""

    STRAIGHT_ON = 0
    SHORTENED = 1
    EXTENDED = 2
    CHORD = 3
    ARC = 4
    SWITCHED = 5
    """The side changes: straight from the offset end of the first element to the offset start of the next."""
    LEAD = 6
    """Straight to, or from, the offset point at the contour's end."""


@dataclass(frozen=True)
class Transitions:
    """Columns of J corners.

    Attributes:
        kind: (J,) ``Transition``.
        first: (J, 3) end of the offset of the first element, from its programmed end.
        last: (J, 3) start of the offset of the second, from its programmed start.
        added: (J, 4, 3) points added between, from the programmed start of the second, in order; NaN where unused.
    """

    kind: Array
    first: Array
    last: Array
    added: Array


def transitions(
    elements: ContourElements, first: Array, second: Array, options: OffsetOptions, rounded: Array
) -> Transitions:
    """Joints of pairs of elements; NaN where their offsets do not meet.

    Args:
        elements: the elements of all contours.
        first: (J,) the elements that end at the corners.
        second: (J,) those that begin there. If one is not the next element, those between were removed, and the
            remaining two have to meet.
        options: options of corners and leads.
        rounded: (J,) whether an outer corner is rounded by an arc.
    """
    corner = corner_geometry(elements, first, second)
    kind = _kinds(elements, first, second, corner, options, rounded)
    # An arc cannot be extended, and leads must stay in place: a line is added there.
    fixed_first = (elements.turn[first] != 0) | (elements.role[first] == Role.START) | corner.resized
    fixed_second = (elements.turn[second] != 0) | (elements.role[second] == Role.CANCEL)
    extended, shortened = kind == Transition.EXTENDED, kind == Transition.SHORTENED
    extension = (corner.radius_resized + corner.radius_second) / (1.0 + np.where(extended, corner.cosine, 0.0))[:, None]
    meeting = np.full_like(extension, np.nan)
    meeting[shortened] = _shortened_ends(elements, first[shortened], second[shortened], corner.rows(shortened))
    lead_in = (elements.role[first] == Role.START) & (elements.role[second] != Role.CANCEL)
    ends = _chosen(
        corner.radius_first,
        (extended & ~fixed_first, extension),
        (shortened, meeting),
        ((kind == Transition.LEAD) & lead_in, corner.radius_second + corner.gap),
    )
    begins = _chosen(corner.radius_second, (extended & ~fixed_second, extension), (shortened, meeting - corner.gap))
    added = _corner_points(kind, corner, extended & fixed_first, extended & fixed_second, extension)
    return Transitions(kind, ends, begins, added)


def _kinds(
    elements: ContourElements,
    first: Array,
    second: Array,
    corner: CornerGeometry,
    options: OffsetOptions,
    rounded: Array,
) -> Array:
    """Kinds of the corners, (J,): the first rule that holds counts."""
    offset = elements.offset[second]
    lead = (elements.role[first] == Role.START) | (elements.role[second] == Role.CANCEL)
    adjacent = second == first + 1
    no_turn = np.abs(corner.sine) < NO_TURN
    inner = ~no_turn & (offset * corner.sine > 0)
    little = (np.abs(corner.sine) <= np.sin(_LEAST_ARC)) & (corner.cosine > 0)
    # A rapid move goes around by lines, whatever the options ask for.
    arcs = rounded & ~elements.rapid[second] & ~little
    return np.select(
        [
            lead & ((options.leads == "A") | inner | ~adjacent),
            elements.offset[first] * offset < 0,
            ~adjacent,
            no_turn & (corner.cosine > 0),
            inner,
            arcs,
            corner.cosine >= -_RIGHT_ANGLE,
        ],
        [
            Transition.LEAD,
            Transition.SWITCHED,
            Transition.SHORTENED,
            Transition.STRAIGHT_ON,
            Transition.SHORTENED,
            Transition.ARC,
            Transition.EXTENDED,
        ],
        Transition.CHORD,
    )


def _corner_points(
    kind: Array, corner: CornerGeometry, to_extension: Array, from_extension: Array, extension: Array
) -> Array:
    """Points added between the ends of both offsets, from the programmed start of the second, (J, 4, 3)."""
    chord, arc = kind == Transition.CHORD, kind == Transition.ARC
    size = norm(corner.radius_second)[:, None]
    outer = chord | arc | (kind == Transition.EXTENDED) | (kind == Transition.STRAIGHT_ON)
    across = (kind == Transition.SWITCHED) & (norm(corner.radius_second - corner.radius_first) > SAME)
    return _packed((
        (corner.resized & outer, corner.radius_resized),
        (to_extension, extension),
        (chord, corner.radius_resized + size * corner.tangent_first),
        (chord, corner.radius_second - size * corner.tangent_second),
        (from_extension | chord | arc | across, corner.radius_second),
    ))  # fmt: skip


def _chosen(otherwise: Array, *choices: tuple[Array, Array]) -> Array:
    """For each row the vector of the condition that holds, (J, 3)."""
    vectors = otherwise
    for condition, value in choices:
        vectors = np.where(condition[:, None], value, vectors)
    return vectors


def _packed(added: tuple[tuple[Array, Array], ...]) -> Array:
    """The points of the conditions that hold, in order, (J, 4, 3): at most four hold at once."""
    conditions = np.stack([condition for condition, _ in added], axis=1)
    points = np.stack([point for _, point in added], axis=1)
    packed = np.full((len(conditions), MAX_CORNER_POINTS, 3), np.nan)
    row, column = np.nonzero(conditions)
    packed[row, (np.cumsum(conditions, axis=1) - 1)[row, column]] = points[row, column]
    return packed


@dataclass(frozen=True)
class CornerGeometry:
    """Geometry at J corners.

    Attributes:
        normal: (J, 3) normal of the plane.
        tangent_first: (J, 3) direction of the first element at its end.
        tangent_second: (J, 3) direction of the second at its start.
        sine: (J,) sine of the turn from first to second, positive to the left.
        cosine: (J,) cosine of that turn.
        gap: (J, 3) from the end of the first to the start of the second in the plane; zero unless elements were
            removed.
        radius_first: (J, 3) radius vector of the first element.
        radius_second: (J, 3) radius vector of the second.
        radius_resized: (J, 3) radius vector of the first element with the offset of the second.
        resized: (J,) whether the offset changes in size.
    """

    normal: Array
    tangent_first: Array
    tangent_second: Array
    sine: Array
    cosine: Array
    gap: Array
    radius_first: Array
    radius_second: Array
    radius_resized: Array
    resized: Array

    def rows(self, chosen: Array) -> CornerGeometry:
        """The chosen rows."""
        return CornerGeometry(**{name: column[chosen] for name, column in vars(self).items()})


def corner_geometry(elements: ContourElements, first: Array, second: Array) -> CornerGeometry:
    """The corners between pairs of elements, which end and begin there, (J,) each."""
    normal = elements.normal[first, 1]
    tangents = elements.tangent[first, 1], elements.tangent[second, 0]
    left_first, left_second = (cross(normal, tangent) for tangent in tangents)
    before, after = elements.offset[first][:, None], elements.offset[second][:, None]
    gap = across(elements.start[second] - elements.end[first], normal)
    return CornerGeometry(
        normal=normal,
        tangent_first=tangents[0],
        tangent_second=tangents[1],
        sine=dot(normal, cross(*tangents)),
        cosine=dot(*tangents),
        gap=np.where((second == first + 1)[:, None], 0.0, gap),
        radius_first=before * left_first,
        radius_second=after * left_second,
        radius_resized=after * left_first,
        resized=np.abs(before - after)[:, 0] > 0,
    )


def _shortened_ends(elements: ContourElements, first: Array, second: Array, corner: CornerGeometry) -> Array:
    """Meeting points of shortened offsets, from the programmed end of the first element, (J, 3)."""
    radius = elements.offset_radius
    arc = elements.turn != 0
    ending = OffsetCurves(
        corner.radius_first, corner.tangent_first, -elements.from_centre[first, 1], radius[first, 1], arc[first]
    )
    beginning = OffsetCurves(
        corner.gap + corner.radius_second,
        corner.tangent_second,
        corner.gap - elements.from_centre[second, 0],
        radius[second, 0],
        arc[second],
    )
    too_large = (ending.radius < 0) | (beginning.radius < 0)
    return np.where(too_large[:, None], np.nan, intersections(ending, beginning, corner.normal))


@dataclass(frozen=True)
class OffsetCurves:
    """Offset curves at a corner, J rows.

    Attributes:
        point: (J, 3) the end of the radius vector, on the curve.
        tangent: (J, 3) unit direction of travel there.
        centre: (J, 3) centre of the circle; NaN for lines.
        radius: (J,) radius of the circle, NaN for lines.
        arc: (J,) whether it is a circle.
    """

    point: Array
    tangent: Array
    centre: Array
    radius: Array
    arc: Array


def intersections(first: OffsetCurves, second: OffsetCurves, normal: Array) -> Array:
    """Intersections of the curves that end and begin at each corner, (J, 3), in the plane of a normal, (J, 3)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        lines = _line_line(first, second, normal)
        on_first = first.point + _along(first, second)[:, None] * first.tangent
        on_second = second.point + _along(second, first)[:, None] * second.tangent
        circles = _circle_circle(first, second, normal)
    points = np.where(second.arc[:, None], on_first, lines)
    return np.where(first.arc[:, None], np.where(second.arc[:, None], circles, on_second), points)


def _line_line(first: OffsetCurves, second: OffsetCurves, normal: Array) -> Array:
    """Intersections of lines, (J, 3): p1 + x t1 = p2 + y t2, times n x t2, gives x."""
    across_second = cross(normal, second.tangent)
    apart = dot(second.point - first.point, across_second)
    slope = dot(first.tangent, across_second)
    one_line = (np.abs(slope) < NO_TURN) & (np.abs(apart) < SAME) & (dot(first.tangent, second.tangent) > 0)
    way = np.where(np.abs(slope) < NO_TURN, np.where(one_line, 0.0, np.nan), apart / slope)
    return first.point + way[:, None] * first.tangent


def _along(line: OffsetCurves, circle: OffsetCurves) -> Array:
    """Distance along lines from their point to circles, (J,): the shorter of both."""
    from_centre = line.point - circle.centre
    half = dot(from_centre, line.tangent)
    excess = dot(from_centre, from_centre) - circle.radius**2
    # This form avoids cancellation in the shorter distance.
    farther = -half - np.where(half < 0, -1.0, 1.0) * np.sqrt(half**2 - excess)
    return np.where(farther == 0, 0.0, excess / farther)


def _circle_circle(first: OffsetCurves, second: OffsetCurves, normal: Array) -> Array:
    """Intersections of two circles lie on their radical line, across the line of centres."""
    between = second.centre - first.centre
    distance = np.sqrt(dot(between, between))
    towards = between / distance[:, None]
    along = (distance**2 + (first.radius - second.radius) * (first.radius + second.radius)) / (2 * distance)
    aside = np.sqrt((first.radius - along) * (first.radius + along))[:, None] * cross(normal, towards)
    foot = first.centre + along[:, None] * towards
    nearer = np.where(dot(foot, aside) > 0, -1.0, 1.0)
    return foot + nearer[:, None] * aside
