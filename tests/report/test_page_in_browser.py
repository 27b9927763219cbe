# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page of the report in a browser without a network: turned, moved, zoomed, marked, and looked at."""

import base64
import json
import re

import numpy as np
import pytest
from browser import CHROMIUM, Page, take_picture
from matplotlib.image import imread
from programs import cone

from pkm_post.machine import machine_named
from pkm_post.posting.steps import post

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium here, as apt's chromium")

WIDTH, HEIGHT = 1100, 900
VIEW = {"turn": -0.9, "tilt": 0.45, "zoom": 1.0, "x": 0.0, "y": 0.0}
"""The page's first view: turn about z and tilt, rad; the zoom; and the shift, pixels."""
RADIANS_PER_PIXEL = 1 / 150
EDGES = "(({x, y, width, height}) => [x, y, width, height])"
"""What a script gives of a rectangle."""
CUTTING, MARK = "--c1", "--bad"
"""Names of the colours of the first operation, and of the marked instant."""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    folder = tmp_path_factory.mktemp("browsed")
    post(cone(), machine_named("example_6tps")[0], folder / "part.pmc")
    return folder / "part-report.html"


@pytest.fixture(scope="module")
def drawn(file):
    """The drawn points of the cutting moves, (N, 3); the time of each; and the middle and the size of the box."""
    data = json.loads(re.search(r'id="path-data">(.*?)</script>', file.read_text(encoding="utf-8")).group(1))
    tip, time = (np.frombuffer(base64.b64decode(data[name]), "<f4") for name in ("tip", "time"))
    rows = np.concatenate([np.arange(run["first"], run["last"] + 1) for run in data["runs"] if not run["rapid"]])
    low, high = np.array(data["low"]), np.array(data["high"])
    return tip.reshape(-1, 3)[rows], time[rows], (low + high) / 2, float(np.linalg.norm(high - low))


@pytest.fixture
def page(file, tmp_path):
    made = Page(tmp_path / "profile", WIDTH, HEIGHT)
    try:
        made.call("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)
        made.open(file.as_uri())
        yield made
    finally:
        made.close()


def colour(page, name):
    """A colour of the page, (3,) of 0 to 1."""
    text = page.value(f"getComputedStyle(document.documentElement).getPropertyValue('{name}').trim()")
    return np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)]) / 255


def box(page):
    """Left, top, width and height of the canvas in the window."""
    values = (
        "(({x, y, width, height}) => [x, y, width, height])(document.getElementById('path').getBoundingClientRect())"
    )
    return np.array(page.value(values))


def on_screen(drawn, canvas, **changes):
    """Where the points are in the window, (N, 2): turned about z, then tilted about the horizontal, and scaled to fit.

    The rotation is made of matrices here, not of the formulas of the page.
    """
    view, (points, _, middle, size) = {**VIEW, **changes}, drawn
    c, s, up, out = *np.array([np.cos(view["turn"]), np.sin(view["turn"])]), np.cos(view["tilt"]), np.sin(view["tilt"])
    turned = (points - middle) @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T
    tilted = turned @ np.array([[1.0, 0.0, 0.0], [0.0, out, up], [0.0, 0.0, 0.0]]).T
    scale = 0.9 * view["zoom"] * min(canvas[2:]) / size
    return canvas[:2] + canvas[2:] / 2 + [view["x"], view["y"]] + scale * tilted[:, :2] * [1.0, -1.0]


def share_of(picture, wanted, places):
    """The share of places with a pixel beside them of a colour, as a thin line has it: mixed with a part of white."""
    ink, paper = 1.0 - picture[..., :3], 1.0 - wanted
    part = ink @ paper / (paper @ paper)
    near = (part > 0.3) & (np.linalg.norm(ink - part[..., None] * paper, axis=2) < 0.1)
    x, y = np.round(places).astype(int).T
    around = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
    found = np.any(
        [near[np.clip(y + dy, 0, len(near) - 1), np.clip(x + dx, 0, near.shape[1] - 1)] for dx, dy in around], 0
    )
    return found.mean()


def seen(page, drawn, folder, **changes):
    """The share of the path that is seen where a view has it."""
    picture = imread(page.picture(folder / "page.png"))
    return share_of(picture, colour(page, CUTTING), on_screen(drawn, box(page), **changes))


def test_the_page_opens_without_a_network_and_without_an_error(page, file):
    asked = [each["params"]["request"]["url"] for each in page.events if each["method"] == "Network.requestWillBeSent"]
    assert asked == [file.as_uri()]
    assert not [each for each in page.events if each["method"] in ("Runtime.exceptionThrown", "Log.entryAdded")]
    assert page.value("document.title") == "part.FCStd on Example 6-TPS"


def test_a_drag_turns_the_path(page, drawn, tmp_path):
    assert seen(page, drawn, tmp_path) > 0.98
    x, y, wide, high = box(page)
    middle = np.array([x + wide / 2, y + high / 2])
    page.drag(middle, middle + [120.0, 45.0])
    turned = {"turn": VIEW["turn"] - 120 * RADIANS_PER_PIXEL, "tilt": VIEW["tilt"] + 45 * RADIANS_PER_PIXEL}
    assert seen(page, drawn, tmp_path, **turned) > 0.98
    assert seen(page, drawn, tmp_path) < 0.5
    for count in (1, 2):
        page.click(middle, count)
    assert seen(page, drawn, tmp_path) > 0.98  # a double click is back at the first view


@pytest.mark.parametrize("how", [{"button": "right"}, {"modifiers": 8}], ids=["right button", "shift"])
def test_the_path_is_moved(page, drawn, tmp_path, how):
    x, y, wide, high = box(page)
    middle = np.array([x + wide / 2, y + high / 2])
    page.drag(middle, middle + [60.0, -40.0], **how)
    assert seen(page, drawn, tmp_path, x=60.0, y=-40.0) > 0.98
    assert seen(page, drawn, tmp_path) < 0.5


def test_the_wheel_zooms(page, drawn, tmp_path):
    x, y, wide, high = box(page)
    page.mouse("mouseWheel", x + wide / 2, y + high / 2, deltaX=0, deltaY=200)
    assert page.value("window.scrollY") == 0  # the page stays
    assert seen(page, drawn, tmp_path, zoom=float(np.exp(-200 / 500))) > 0.98
    assert seen(page, drawn, tmp_path) < 0.5


def test_a_click_on_a_row_marks_its_instant_everywhere(page, drawn, tmp_path):
    row = "[...document.querySelectorAll('tr[data-time]')].find((row) => 0.5 < row.dataset.time)"
    instant = float(page.value(f"{row}.dataset.time"))
    page.value(f"{row}.scrollIntoView({{block: 'center'}})")
    where = f"(({{x, y, width, height}}) => [x + width / 2, y + height / 2])({row}.getBoundingClientRect())"
    page.click(page.value(where))
    assert page.value(f"{row}.className") == "chosen"
    charts = page.value("document.querySelectorAll('svg.chart').length")
    assert page.value("document.querySelectorAll('svg.chart .marker').length") == charts > 3
    page.value("window.scrollTo(0, 0)")
    nearest = int(np.argmin(np.abs(drawn[1] - instant)))
    picture = imread(page.picture(tmp_path / "marked.png"))
    assert share_of(picture, colour(page, MARK), on_screen(drawn, box(page))[[nearest]]) == 1.0


def test_a_picture_of_the_page_shows_its_parts(file, page, drawn, tmp_path):
    tall = int(page.value("document.documentElement.scrollHeight"))
    take_picture(file.as_uri(), tmp_path / "page.png", tmp_path / "another profile", WIDTH, tall)
    picture = imread(tmp_path / "page.png")
    assert picture.shape[:2] == (tall, WIDTH)
    assert share_of(picture, colour(page, CUTTING), on_screen(drawn, box(page))) > 0.98
    # of every chart the curves are seen within its frame
    frames = page.value(
        f"[...document.querySelectorAll('svg.chart')].map((each) => each.getBoundingClientRect()).map({EDGES})"
    )
    for left, top, wide, high in np.round(frames).astype(int):
        frame = picture[top : top + high, left : left + wide, :3]
        strong = np.ptp(frame, axis=2) > 0.3
        assert strong.any(axis=0).mean() > 0.5, "curves go from left to right"
