# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables: the tables of the report page as HTML, with lengths and speeds in mm or inch.

Input: parts of the content of the report, in mm, and the unit of lengths on the page. Output: text; a row with an
instant can be clicked.
"""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

_MM_IN_INCH = 25.4
_SMALL = 0.1
"""mm: quantities with a limit up to this are shown in um."""


class Shown(NamedTuple):
    """Display form of a unit.

    Attributes:
        factor: of a value in the unit of the report.
    """

    unit: str
    factor: float = 1.0

    def text(self, value: float) -> str:
        """A value with its unit."""
        return f"{self.factor * value:.4g} {self.unit}".rstrip()


INCH = {
    "mm": Shown("in", 1 / _MM_IN_INCH),
    "um": Shown("in", 1e-3 / _MM_IN_INCH),
    "mm/s": Shown("in/min", 60 / _MM_IN_INCH),
    "mm/s^2": Shown("in/s^2", 1 / _MM_IN_INCH),
    "mm/s^3": Shown("in/s^3", 1 / _MM_IN_INCH),
}
"""Units with lengths, by those of the report."""


def shown(unit: str, of_page: str, limit: float | None = None) -> Shown:
    """Display form of a unit of the report on a page.

    Args:
        unit: such as mm or degrees.
        of_page: mm or inch.
        limit: of the quantity, in ``unit``; small lengths are in um.
    """
    if of_page == "inch":
        return INCH.get(unit, Shown(unit))
    return Shown("um", 1000.0) if unit == "mm" and limit is not None and 0.0 < limit <= _SMALL else Shown(unit)


def certificate_tables(certificate: Mapping[str, Any], of_page: str) -> str:
    """The worst values with their limits, and the coverage; ``of_page`` is the unit of lengths, mm or inch."""
    findings = "".join(_finding(row, of_page) for row in certificate["findings"])
    figures = "".join(
        _finding(figure | {"limit": None, "holds": True, "is_least": False}, of_page)
        for figure in certificate["figures"]
    )
    covered = "".join(
        _row([row["topic"], row["what"], row["extent"], row["detail"]]) for row in certificate["coverage"]
    )
    return (
        f"<h2>Worst values, {certificate['instants']} poses measured</h2>\n"
        "<table><tr><th>quantity<th>value<th>limit<th>time, s<th>operation<th>line</tr>"
        f"{findings}{figures}</table>\n"
        "<h2>What certified means</h2>\n"
        f"<table><tr><th>topic<th>hazard<th>coverage<th>how</tr>{covered}</table>"
    )


def _finding(row: Mapping[str, Any], of_page: str) -> str:
    quantity = shown(row["unit"], of_page, row["limit"])
    value = "none" if row["value"] is None else quantity.text(row["value"])
    bound = "at least " if row["is_least"] else ""
    limit = "" if row["limit"] is None else f"{bound}{quantity.text(row['limit'])}"
    cells = [row["what"], value, limit, f"{row['time_s']:.3f}", row["operation"], str(row["line"])]
    fails = "" if row["holds"] else ' class="fails"'
    return f'<tr data-time="{row["time_s"]:.6g}"{fails}>{row_cells(cells)}</tr>'


def time_table(machining: Mapping[str, Any]) -> str:
    """The time of each operation."""
    rows = (
        _row([one["name"], *(f"{one[part]:.1f}" for part in ("cutting_s", "rapid_s", "dwell_s"))])
        for one in machining["operations"]
    )
    return (
        f"<h2>Machining time, s</h2>\n<table><tr><th>operation<th>cutting<th>rapid<th>dwell</tr>{''.join(rows)}</table>"
    )


def tool_table(tools: Sequence[Mapping[str, Any]], of_page: str) -> str:
    """The tools with their sizes."""
    size = shown("mm", of_page).text
    rows = "".join(
        _row([
            f"T{tool['number']}", tool["name"],
            size(tool["diameter"]) if tool["diameter"] else _UNKNOWN,
            size(tool["corner_radius"]) if tool["diameter"] and tool["corner_known"] else _UNKNOWN,
            size(tool["length"]),
        ])
        for tool in tools
    )  # fmt: skip
    head = "<tr><th>number<th>tool<th>diameter<th>corner radius<th>gauge length</tr>"
    return f"<h2>Tools</h2>\n<table>{head}{rows}</table>"


_UNKNOWN = "not known"


def setup_table(setup: Mapping[str, Any], of_page: str) -> str:
    """The work frame and the set-up; empty if both are unknown."""
    rows = []
    if offset := setup.get("work_offset"):
        rows.append(["work offset", offset["name"]])
        long = shown("mm", of_page)
        place = [long.factor * value for value in offset["origin_mm"]]
        rows.append([f"its origin in the machine frame, {long.unit}", _vector(place)])
        rows += [[f"its {axis} axis there", _vector(offset[f"{axis}_axis"])] for axis in "xyz"]
    for kind in ("part", "stock"):
        if kind in setup:
            rows.append([kind, setup[kind] or "not known: no collisions with it were looked for"])
    if "fixtures" in setup:
        rows.append(["fixtures", ", ".join(setup["fixtures"]) or "not known: no collisions with them were looked for"])
    return f"<h2>Set-up</h2>\n<table>{''.join(map(_row, rows))}</table>" * bool(rows)


def _vector(values: Sequence[float]) -> str:
    return "  ".join(f"{value:.9g}" for value in values)


def origin(report: Mapping[str, Any]) -> str:
    """Hashes of the files, and the interpretation of the source."""
    files = report["files"]
    rows = [
        ("machine file", report["machine"]["sha256"]),
        ("trajectory", files.get("trajectory_sha256", "")),
        *(("program", digest) for digest in files.get("programs_sha256", [])),
    ]
    hashes = "".join(f"<tr><td>{name}<td><code>{digest}</code></tr>" for name, digest in rows)
    reading = "".join(f"<li>{html.escape(line)}</li>" for line in report["program"]["reading"])
    return (
        f"<h2>Files, SHA-256</h2>\n<table>{hashes}</table>"
        + f"<h2>How the source was read</h2><ul>{reading}</ul>" * bool(reading)
    )


def _row(cells: Sequence[str]) -> str:
    return f"<tr>{row_cells(cells)}</tr>"


def row_cells(cells: Sequence[str]) -> str:
    """The cells of a row of a table."""
    return "".join(f"<td>{html.escape(cell)}</td>" for cell in cells)
