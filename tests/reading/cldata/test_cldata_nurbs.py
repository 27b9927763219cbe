# SPDX-License-Identifier: LGPL-2.1-or-later
"""MOVNRB of Creo: points on the curve by de Boor's algorithm, chords within tolerance, and the feeds of the file."""

import numpy as np
import pytest

from pkm_post.model import Kind
from pkm_post.model.diagnostics import errors
from pkm_post.reading.cldata import ReadOptions, read
from pkm_post.reading.cldata.nurbs import CHORD_TOLERANCE

HEAD = "UNITS/MM\nLOADTL/1,LENGTH,100\nFEDRAT/600,MMPM\nRAPID\n"


def de_boor(knots, degree, poles, at):
    """One point of a curve, by repeated interpolation between control points."""
    span = min(max(int(np.searchsorted(knots, at, "right")) - 1, degree), len(poles) - 1)
    points = [np.array(poles[index], dtype=float) for index in range(span - degree, span + 1)]
    for level in range(1, degree + 1):
        for index in range(degree, level - 1, -1):
            low, high = knots[span - degree + index], knots[span + 1 + index - level]
            share = (at - low) / (high - low)
            points[index] = (1 - share) * points[index - 1] + share * points[index]
    return points[degree]


class Curve:
    """A random curve with its statements."""

    def __init__(self, seed, degree, count, five_axis=False):
        random = np.random.default_rng(seed)
        inner = np.sort(random.uniform(0, 10, count - degree - 1)).round(4)
        self.knots = np.concatenate([[0.0] * (degree + 1), inner, [10.0] * (degree + 1)])
        self.degree, self.five_axis = degree, five_axis
        self.poles = np.cumsum(random.uniform(-3, 9, (count, 3)), axis=0).round(4)
        lean = np.column_stack([random.uniform(-20, 20, (count, 2)), np.full(count, 100.0)])
        self.high = (self.poles + lean).round(4)
        self.at = np.linspace(0, 10, 7)

    def __call__(self, at, high=False):
        return de_boor(self.knots, self.degree, self.high if high else self.poles, at)

    def statements(self, points=None):
        axes = "5AXIS,LENGTH,100" if self.five_axis else "M3AXIS"
        order, count = self.degree + 1, len(self.poles)
        lines = [f"MOVNRB / {axes}", f"MOVNRB/ON,{order},{len(self.knots)},0,{count},99.5"]
        data = [(1, self.knots), (2, self.poles.ravel())] + [(3, self.high.ravel())] * self.five_axis
        for what, values in data:
            texts = [f"{value:.4f}" for value in values]
            lines += [f"MOVNRB/{what},{','.join(texts[at : at + 24])}" for at in range(0, len(texts), 24)]
        lines.append("MOVNRB/NEXT")
        points = [self(at) for at in self.at] if points is None else points
        lines += [f"GOTO/{','.join(f'{value:.6f}' for value in point)}" for point in points]
        return "\n".join([*lines, "MOVNRB/OFF"]) + "\n"


def program(text):
    found, diagnostics = read(text, "part.ncl", ReadOptions(dialect="creo"))
    assert found is not None, "\n".join(map(str, diagnostics))
    return found


def start_of(curve):
    return f"{HEAD}GOTO/{','.join(f'{value:.6f}' for value in curve(0.0))}\n"


def off_curve(curve, places):
    """Distance of places from a curve: from chords of 4000 points of it, which are within 2 um of it here."""
    line = np.array([curve(at) for at in np.linspace(0, 10, 4000)])
    along = np.diff(line, axis=0)
    share = np.einsum("pnk,nk->pn", places[:, None] - line[:-1], along) / np.einsum("nk,nk->n", along, along)
    feet = line[:-1] + np.clip(share, 0, 1)[..., None] * along
    return np.linalg.norm(places[:, None] - feet, axis=2).min(axis=1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "degree", "count"), [(1, 3, 4), (2, 3, 9), (3, 2, 6), (4, 5, 12), (5, 1, 5), (6, 3, 30)]
)
def test_chords_keep_to_the_curve(seed, degree, count):
    curve = Curve(seed, degree, count)
    found = program(f"{start_of(curve)}{curve.statements()}FINI\n").position
    assert found[0] == pytest.approx(curve(0.0), abs=1e-6) and found[-1] == pytest.approx(curve(10.0), abs=1e-9)
    assert (np.linalg.norm(np.diff(found[1:], axis=0), axis=1) > 1e-6).all()
    some = slice(None, None, max(len(found) // 40, 1))
    middles = (found[1:] + found[:-1])[some] / 2
    assert off_curve(curve, np.concatenate([found[some], middles])).max() < CHORD_TOLERANCE + 2.5e-3


def test_the_bound_of_the_chords_is_kept_on_a_parabola():
    """With y = x^2 / 40, of degree 2: the second derivative is constant, and the deviation h^2 / 8 times 1 / 20."""
    text = "MOVNRB/M3AXIS\nMOVNRB/ON,3,6,0,3,43\nMOVNRB/1,0,0,0,1,1,1\nMOVNRB/2,-20,10,0,0,-10,0,20,10,0\nMOVNRB/NEXT\n"
    found = program(f"{HEAD}GOTO/-20,10,0\n{text}GOTO/20,10,0\nMOVNRB/OFF\nFINI\n").position
    assert found[:, 1] == pytest.approx(found[:, 0] ** 2 / 40, abs=1e-9)
    sag = np.max(np.diff(found[:, 0])) ** 2 / 8 / 20
    assert 0.8 * CHORD_TOLERANCE < sag <= CHORD_TOLERANCE


@pytest.mark.slow
def test_axes_follow_the_second_curve():
    curve = Curve(7, 3, 8, five_axis=True)
    found = program(f"{start_of(curve)}{curve.statements([[*curve(at), 0, 0, 1] for at in curve.at])}FINI\n")
    for place, axis in zip(found.position[1::40], found.tool_axis[1::40], strict=True):
        at = min(np.linspace(0, 10, 2001), key=lambda one: np.linalg.norm(curve(one) - place))
        lean = curve(at, high=True) - curve(at)
        assert axis == pytest.approx(lean / np.linalg.norm(lean), abs=2e-3)


def test_feeds_between_points_apply_between_their_places_and_lines_are_those_of_the_points():
    curve = Curve(8, 3, 6)
    points = [curve(at) for at in (2.0, 5.0, 10.0)]
    text = curve.statements(points)
    first, second, third = (f"GOTO/{','.join(f'{value:.6f}' for value in point)}\n" for point in points)
    text = text.replace(second, f"FEDRAT/300,MMPM\n{second}")
    found = program(f"{start_of(curve)}{text}FINI\n")
    slow = np.isclose(found.feed * 60, 300)
    switch = int(np.argmax(slow))
    assert (found.kind[1:] == Kind.LINE).all() and slow[switch:].all()
    assert found.position[switch - 1] == pytest.approx(points[0], abs=1e-3)
    assert len(set(found.line[1:].tolist())) == 3 and (np.diff(found.line) >= 0).all()


def test_inches_are_read_in_inches():
    curve = Curve(9, 3, 6)
    text = start_of(curve).replace("MM\n", "INCHES\n", 1) + curve.statements() + "FINI\n"
    found = program(text)
    assert found.position[-1] == pytest.approx(curve(10.0) * 25.4, abs=1e-6)


GOOD = Curve(10, 3, 6)


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("ON,4,10,0,6", "ON,4,10,6,6", "L446"),
        ("ON,4,10,0,6", "ON,4,11,0,6", "L446"),
        ("ON,4,10,0,6", "ON,4,10,0,7", "L446"),
        ("ON,4,10,0,6", "ON,3,10,0,6", "L446"),
        ("10.0000,10.0000,10.0000", "10.0000,10.0000,9.0000", "L446"),
        ("MOVNRB/OFF\n", "", "L446"),
        ("MOVNRB/NEXT\n", "", "L402"),
        ("MOVNRB / M3AXIS\n", "", "L402"),
        ("MOVNRB/NEXT\n", "MOVNRB/NEXT\nGOTO/900,0,0\n", "L446"),
        ("MOVNRB/ON", "MOVNRB/4,1\nMOVNRB/ON", "L402"),
    ],
)
def test_curves_that_are_refused(old, new, code):
    text = f"{start_of(GOOD)}{GOOD.statements()}FINI\n"
    assert old in text
    found, diagnostics = read(text.replace(old, new, 1), "part.ncl", ReadOptions(dialect="creo"))
    assert (found, errors(diagnostics)[0].code) == (None, code)


def test_a_curve_that_has_only_begun_is_refused():
    found, diagnostics = read(f"{HEAD}GOTO/0,0,0\nMOVNRB/M3AXIS\nGOTO/1,0,0\nFINI\n", "part.ncl", ReadOptions())
    assert (found, [fault.code for fault in errors(diagnostics)]) == (None, ["L446"])


@pytest.mark.parametrize("which", [slice(None, -1), slice(2, None)])
def test_a_curve_longer_than_its_points_is_refused(which):
    points = [GOOD(at) for at in GOOD.at][which]
    text = f"{HEAD}GOTO/500,0,0\n{GOOD.statements(points)}FINI\n"
    assert errors(read(text, "part.ncl", ReadOptions(dialect="creo"))[1])[0].code == "L446"
