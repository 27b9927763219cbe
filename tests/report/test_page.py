# SPDX-License-Identifier: LGPL-2.1-or-later
import base64
import dataclasses
import json
import re

import numpy as np
import pytest
from programs import cone

from pkm_post.machine import machine_named
from pkm_post.options import Options
from pkm_post.posting.steps import post

MARKUP = "</script><script>alert(1)</script>"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("page")
    posted = post(cone(), machine_named("example_6tps")[0], folder / "part.pmc")
    return posted, (folder / "part-report.html").read_text(encoding="utf-8")


def path_data(page):
    """The drawn path: points, instants and runs."""
    data = json.loads(re.search(r'id="path-data">(.*?)</script>', page).group(1))
    floats = {name: np.frombuffer(base64.b64decode(data[name]), "<f4") for name in ("tip", "time", "axes")}
    return floats["tip"].reshape(-1, 3), floats["time"], floats["axes"].reshape(-1, 2, 3), data["runs"]


def test_the_drawn_path_is_the_programmed_one(made):
    tip, time, axes, runs = path_data(made[1])
    program = cone()
    box = made[0].report["program"]["box_mm"]
    np.testing.assert_allclose(
        tip[time >= runs[0]["last"] * 0][-1], np.array(program.position[-1]) + [0, 0, 150], atol=1e-3
    )
    assert (tip >= np.array(box[0]) - 0.01).all()
    assert np.all(np.diff(time) >= 0) and time[0] == 0
    assert time[-1] == pytest.approx(made[0].report["motion"]["duration_s"], rel=1e-6)
    np.testing.assert_allclose(np.linalg.norm(axes[:, 1] - axes[:, 0], axis=1), 15.0, rtol=1e-5)


def test_runs_cover_the_path_and_part_rapid_from_cutting(made):
    _, time, _, runs = path_data(made[1])
    assert runs[0]["first"] == 0 and runs[-1]["last"] == len(time) - 1
    assert all(one["last"] == next_["first"] for one, next_ in zip(runs, runs[1:], strict=False))
    assert [run["rapid"] for run in runs][0] and not runs[-1]["rapid"]


def test_every_finding_and_every_hazard_has_its_row(made):
    posted, page = made
    certificate = posted.report["certificate"]
    limits = posted.report["feed"]["limits"]
    assert page.count("<tr data-time=") == len(certificate["findings"]) + len(certificate["figures"]) + len(limits)
    for row in certificate["coverage"]:
        assert f"<td>{row['what']}<" in page
    assert "Certified, as far as the table below says" in page


def test_the_page_shows_the_feed_and_what_limits_it(made):
    posted, page = made
    feed = posted.report["feed"]
    assert f"{100 * feed['at_feed']:.1f} % of the cutting time" in page
    for row in feed["limits"]:
        assert f"<td>{row['limit']}<" in page


def test_the_page_has_tools_and_set_up(made):
    posted, page = made
    (tool,) = posted.report["program"]["tools"]
    assert f"<td>T{tool['number']}</td><td>{tool['name']}</td>" in page and f"<td>{tool['length']:g} mm<" in page
    setup = posted.report["setup"]
    assert setup["work_offset"] == {
        "name": "G54", "origin_mm": [0.0, 0.0, 150.0], "x_axis": [1.0, 0.0, 0.0], "y_axis": [0.0, 1.0, 0.0],
        "z_axis": [0.0, 0.0, 1.0],
    }  # fmt: skip
    assert "<td>work offset</td><td>G54<" in page and "<td>0  0  150<" in page
    assert setup["part"] == "" and "<td>part</td><td>not known" in page


def test_small_lengths_are_in_um_and_angles_in_degrees(made):
    posted, page = made
    found = {row["what"]: row for row in posted.report["certificate"]["findings"]}
    tip, axis = found["deviation of the tool tip"], found["deviation of the tool axis"]
    assert f"<td>{1000 * tip['value']:.4g} um</td><td>{1000 * tip['limit']:.4g} um<" in page
    assert f"<td>{axis['value']:.4g} degrees<" in page


def test_the_page_can_be_in_inch_and_have_a_date(made, tmp_path):
    options = Options(report_unit="inch", report_date="2026-11-28")
    posted = post(cone(), machine_named("example_6tps")[0], tmp_path / "part.pmc", options)
    page = (tmp_path / "part-report.html").read_text(encoding="utf-8")
    assert posted.report == made[0].report  # the report is in mm, and has no date
    found = {row["what"]: row for row in posted.report["certificate"]["findings"]}
    tip, speed = found["deviation of the tool tip"], found["strut speed"]
    assert f"<td>{tip['value'] / 25.4:.4g} in</td>" in page
    assert f"<td>{speed['value'] / 25.4 * 60:.4g} in/min</td>" in page
    assert "<b>2026-11-28</b>" in page and "2026-11-28" not in made[1]
    without = re.sub(r"<svg.*?</svg>|<script.*?</script>|<h2>What certified.*?</table>", "", page, flags=re.DOTALL)
    assert not re.search(r"\d (mm|um)\b", without)


def test_the_page_needs_no_network(made):
    assert not re.search(r"(src|href)=|https?://(?!www.w3.org/2000/svg)", made[1])


def test_names_are_text(tmp_path):
    program = cone()
    named = dataclasses.replace(program, source=MARKUP, operations=tuple(MARKUP for _ in program.operations))
    post(named, machine_named("example_6tps")[0], tmp_path / "part.pmc")
    page = (tmp_path / "part-report.html").read_text(encoding="utf-8")
    assert "alert(1)" in page and "<script>alert" not in page
    assert page.count("</script>") == 2
