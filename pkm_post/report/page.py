# SPDX-License-Identifier: LGPL-2.1-or-later
"""Page: the report as one HTML file that a browser shows without a network.

Input: the content of the report, the planned motion, the program as read back and its certificate. Output: the file,
with the verdict, the path in 3D, charts over time and the tables. A click on a row or into a chart marks that instant
everywhere. It has a date only if one is given: the same job gives the same bytes.
"""

from __future__ import annotations

import base64
import html
import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pkm_post.geometry import Array, hermite_columns, hermite_lengths, hermite_speeds
from pkm_post.model import FeedStudy, Kind, Motion, StrutMotion, Trajectory, checkpoint, distinct, intervals_at
from pkm_post.report.charts import Line, TimeBand, chart, legend
from pkm_post.report.results import Results
from pkm_post.report.tables import (
    Shown,
    certificate_tables,
    origin,
    row_cells,
    setup_table,
    shown,
    time_table,
    tool_table,
)

_PATH_POINTS = 6000
"""Instants at which the path is drawn in 3D."""
_CHART_POINTS = 1000
"""Instants at which charts show the cubics, in addition to the knots."""
_AXES, _AXIS_LENGTH = 150, 15.0
"""Tool axes drawn, and their length in mm."""
_MM_IN_UM = 1000.0
_FEED_SHOWN = 1.5
"""The chart of the feed ends at this multiple of the highest cutting feed; rapids and the machine may go far beyond."""
_HINT = (
    "drag to turn, shift or right button to move, wheel to zoom, double click to reset; click a row or a chart to mark"
    " an instant"
)


def write_page(path: Path, report: Mapping[str, Any], results: Results) -> None:
    """Write the page of a report.

    Args:
        path: of the HTML file.
        report: the content of the report (``summary.report``).
        results: the data of the report.
    """
    trajectory, machine, motion = results.trajectory, results.machine, results.motion
    duration = float(results.struts.time_ms[-1]) / 1000
    bands = list(_operations(trajectory, motion, duration))
    parts = [
        _heading(report, machine.name, results),
        "<h2>Tool path</h2>",
        f'<p class="hint">{_HINT}</p><canvas id="path"></canvas>',
        f'<script type="application/json" id="path-data">{_path(trajectory, motion)}</script>',
        _feed(report["feed"], results.feed, duration, bands, results.unit),
        _charts(results, duration, bands),
        certificate_tables(report["certificate"], results.unit),
        time_table(report["machining_time"]),
        tool_table(report["program"]["tools"], results.unit),
        setup_table(report["setup"], results.unit),
        origin(report),
    ]
    style, script = (Path(__file__).with_name(name).read_text("utf-8") for name in _ASSETS)
    title = html.escape(f"{trajectory.source} on {machine.name}")
    head = f'<html lang="en"><head><meta charset="utf-8"><title>{title}</title>\n<style>\n{style}</style></head>'
    text = "\n".join(["<!doctype html>", head, "<body>", *parts, f"<script>\n{script}</script>", "</body></html>", ""])
    path.write_text(text, encoding="utf-8", newline="\n")


_ASSETS = ("page.css", "page.js")


def _heading(report: Mapping[str, Any], machine: str, results: Results) -> str:
    certificate, program, motion = report["certificate"], report["program"], report["motion"]
    holds = certificate["holds"]
    verdict = "Certified, as far as the table below says" if holds else "Not certified"
    tolerances = report["tolerances"]
    numbers = {
        "machine": machine,
        "machining time": f"{report['machining_time']['total_s']:g} s",
        "points": f"{motion['points']}",
        "cutting length": shown("mm", results.unit).text(program["cutting_length_mm"]),
        "tolerance of the tip": shown("mm", results.unit, tolerances["tip_mm"]).text(tolerances["tip_mm"]),
        "tolerance of the axis": f"{tolerances['axis_deg']:g} degrees",
    }
    if results.date:
        numbers["date"] = results.date
    items = "".join(f"<li><span>{name}</span> <b>{html.escape(value)}</b></li>" for name, value in numbers.items())
    return (
        f"<h1>{html.escape(program['source'])}</h1>\n"
        f'<p class="verdict{" holds" if holds else ""}">{verdict}</p>\n<ul class="numbers">{items}</ul>'
    )


def _path(trajectory: Trajectory, motion: Motion) -> str:
    """The drawn path as JSON: points, instants, runs of one operation, and tool axes."""
    time, interval, share = _instants(motion.time_ms, _PATH_POINTS)
    after, duration = interval + 1, np.diff(motion.time_ms)[interval] / 1000
    ends = (motion.tip[interval].T, motion.tip_rate[interval].T, motion.tip[after].T, motion.tip_rate[after].T)
    checkpoint()
    tip = hermite_columns(*ends, duration, share[None])[:, 0].T
    checkpoint()
    row = np.minimum(np.searchsorted(motion.joint_time, time), len(trajectory) - 1)
    operation, rapid = trajectory.operation[row], trajectory.kind[row] == Kind.RAPID
    first = np.flatnonzero(np.append(True, (np.diff(operation) != 0) | (np.diff(rapid) != 0)))
    last = np.append(first[1:], len(time) - 1)
    runs = [
        {"first": int(a), "last": int(b), "operation": int(operation[a]), "rapid": bool(rapid[a])}
        for a, b in zip(first, last, strict=True)
    ]
    some = distinct(np.linspace(0, len(motion) - 1, _AXES).astype(int))
    some = some[trajectory.kind[motion.segment[some]] != Kind.RAPID]
    axes = np.stack([motion.tip[some], motion.tip[some] + _AXIS_LENGTH * motion.axis[some]], axis=1)
    shown = tip if rapid.all() else tip[~rapid]
    low, high = shown.min(axis=0), shown.max(axis=0)
    data = {
        "tip": _packed(tip), "time": _packed(time), "axes": _packed(axes), "runs": runs,
        "low": np.round(low, 3).tolist(), "high": np.round(high, 3).tolist(),
    }  # fmt: skip
    return json.dumps(data)


def _packed(values: Array) -> str:
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode("ascii")


def _instants(time_ms: Array, count: int) -> tuple[Array, Array, Array]:
    """Even instants and knots: time, s; the interval of each; and the elapsed share of it.

    If there are more knots than instants, every n-th knot is taken.
    """
    knots = time_ms[:: max(1, len(time_ms) // count)] / 1000
    time = distinct(np.concatenate([knots, np.linspace(0.0, time_ms[-1] / 1000, max(2, count - len(knots)))]))
    interval = intervals_at(time_ms, 1000 * time)
    share = (1000 * time - time_ms[interval]) / (time_ms[interval + 1] - time_ms[interval])
    return time, interval, np.clip(share, 0.0, 1.0)


def _charts(results: Results, duration: float, bands: Sequence[TimeBand]) -> str:
    machine, certificate, tolerances = results.machine, results.certificate, results.tolerances
    long, fast, small = (shown(unit, results.unit) for unit in ("mm", "mm/s", "um"))
    time, length, speed = _sampled_struts(results.struts)
    checkpoint()
    lengths, speeds = (
        [Line(f"strut {number}", time, column, f"c{number}") for number, column in enumerate(values, 1)]
        for values in (long.factor * length, fast.factor * speed)
    )
    tip = Line("tip", certificate.time, small.factor * _MM_IN_UM * certificate.tip_deviation, "c1")
    axis = Line("axis", certificate.time, np.degrees(certificate.axis_deviation), "c2")
    limit, stroke = fast.factor * machine.strut_speed, [long.factor * end for end in machine.strut_stroke]
    return "\n".join(
        [
            "<h2>Struts, as read back from the program</h2>",
            legend(lengths),
            chart(f"length, {long.unit}", lengths, duration, stroke, bands),
            chart(f"speed, {fast.unit}", speeds, duration, (-limit, limit), bands),
            "<h2>Deviation from the programmed path</h2>",
            chart(f"tip, {small.unit}", [tip], duration, [small.factor * _MM_IN_UM * tolerances.tip], bands),
            chart("axis, degrees", [axis], duration, [float(np.degrees(tolerances.axis))], bands),
        ]
    )


def _feed(
    shares: Mapping[str, Any], feed: FeedStudy | None, duration: float, bands: Sequence[TimeBand], of_page: str
) -> str:
    """The feed over time, and its limits."""
    if feed is None or not shares:
        return ""
    fast = shown("mm/s", of_page)
    highest = _FEED_SHOWN * fast.factor * float(feed.programmed[feed.cutting].max())
    lines = [
        Line("programmed", feed.time, fast.factor * feed.programmed, "faint"),
        Line("possible", feed.time, fast.factor * feed.possible, "c3"),
        Line("planned", feed.time, fast.factor * feed.planned, "c1"),
    ]
    rows = "".join(_limit(row, fast) for row in shares["limits"])
    return "\n".join(
        [
            "<h2>Feed</h2>",
            f"<p>{_percent(shares['at_feed'])} of the cutting time at 95 % of the programmed feed or more; the machine"
            f" allows that feed in {_percent(shares['feed_possible'])} of it, and the plan is at 95 % of what is"
            f" possible there in {_percent(shares['as_possible'])}.</p>",
            legend(lines),
            chart(f"tip speed, {fast.unit}", lines, duration, (), bands, (0.0, highest)),
            f"<table><tr><th>what limits the feed<th>share of cutting time<th>slowest, {fast.unit}<th>programmed"
            f"<th>time, s<th>operation<th>line</tr>{rows}</table>",
        ]
    )


def _limit(row: Mapping[str, Any], fast: Shown) -> str:
    cells = [
        row["limit"], _percent(row["share"]), f"{fast.factor * row['slowest_mm_s']:.4g}",
        f"{fast.factor * row['asked_mm_s']:.4g}",
        f"{row['time_s']:.3f}", row["operation"], str(row["line"]),
    ]  # fmt: skip
    return f'<tr data-time="{row["time_s"]:.6g}">{row_cells(cells)}</tr>'


def _percent(share: float) -> str:
    return f"{100 * share:.1f} %"


def _sampled_struts(struts: StrutMotion) -> tuple[Array, Array, Array]:
    """Time, (N,) s; strut lengths and speeds on the cubics, (6, N) each."""
    time, interval, share = _instants(struts.time_ms, _CHART_POINTS)
    p0, v0, p1, v1, duration = struts.cubics(interval)
    ends = p0, v0, p1, v1, duration, share[:, None]
    return time, hermite_lengths(*ends)[:, 0].T, hermite_speeds(*ends)[:, 0].T


def _operations(trajectory: Trajectory, motion: Motion, duration: float) -> Iterable[TimeBand]:
    change = np.flatnonzero(np.diff(trajectory.operation)) + 1
    begin = np.concatenate([[0.0], motion.joint_time[change - 1]])
    end = np.append(begin[1:], duration)
    for row, since, until in zip(np.append(0, change), begin.tolist(), end.tolist(), strict=True):
        yield TimeBand(trajectory.operations[trajectory.operation[row]], since, until)
