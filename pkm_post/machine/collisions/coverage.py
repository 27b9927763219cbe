# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coverage: certificate rows of the collision checks made, and of unknown items."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from pkm_post.model import Coverage, Extent, Phrase, Topic

if TYPE_CHECKING:
    from pkm_post.machine.collisions.contacts import Obstacle
    from pkm_post.machine.collisions.stock_grid import StockGrid

PART_NOT_KNOWN, FIXTURES_NOT_KNOWN, STOCK_NOT_KNOWN = (
    Coverage(Topic.COLLISIONS, subject, Extent.NOT_COVERED, detail)
    for subject, detail in (
        (Phrase("machine and tool against the part"), "part: not known"),
        (Phrase("machine and tool against clamps and fixtures"), "none beside those of the machine file is known"),
        (Phrase("machine and rapid moves against the stock"), "stock: not known"),
    )
)
NO_SETUP = (PART_NOT_KNOWN, FIXTURES_NOT_KNOWN, STOCK_NOT_KNOWN)
"""Collisions with an unknown set-up, as when a program is verified."""
_WHOLE = "along the whole path"


@dataclass
class CoverageRows:
    """The rows under construction.

    Attributes:
        unknown_cutters: names of tools of unknown size.
    """

    unknown_cutters: list[str] = field(default_factory=list)
    _behind: str = ""
    _rows: list[Coverage] = field(default_factory=list)

    def rows(self) -> tuple[Coverage, ...]:
        """All rows."""
        return tuple(self._rows)

    def _add(self, subject: Phrase, extent: Extent, detail: str) -> None:
        self._rows.append(Coverage(Topic.COLLISIONS, subject, extent, detail))

    def not_known(self, row: Coverage) -> None:
        """Record an unknown item of the set-up."""
        self._rows.append(row)

    def machine(self, obstacle: Obstacle, bodies: bool, struts: bool) -> None:
        """Record the check of bodies and struts, if the machine file states them."""
        pairs = (
            (Phrase("spindle and holder"), bodies, "bodies of the platform"),
            (Phrase("struts"), struts, "tubes or rods of the struts"),
        )
        for subject, stated, needed in pairs:
            extent = Extent.PROVEN if stated else Extent.NOT_COVERED
            detail = _detail(obstacle, _WHOLE) if stated else f"the machine file does not state {needed}"
            self._add(_against(subject, obstacle), extent, detail)

    def shanks(self, obstacle: Obstacle, unknown: Sequence[str]) -> None:
        """Record the check of shanks, if they are known."""
        if unknown:
            detail = f"{', '.join(unknown)}: it is not known where the cutting edges end"
            self._add(_against(Phrase("shanks"), obstacle), Extent.NOT_COVERED, detail)
        else:
            self._add(_against(Phrase("shanks"), obstacle), Extent.PROVEN, _detail(obstacle, _WHOLE))

    def points_behind(self, grid: StockGrid) -> None:
        """Record that rapid moves were checked behind surfaces of the part that were cut before."""
        points = f"in {int(grid.filled.sum()):,} points {grid.step:.2g} mm apart"
        self._behind = (
            f"; where its surface was cut before, {points if grid.filled.any() else 'not looked at: open mesh'}"
        )

    def cutters(self, obstacle: Obstacle, allowance: float) -> None:
        """Record the check of cutters, if their size is known."""
        deeper = f", what is deeper than {allowance:g} mm and was not cut before"
        sampled = f"at ends of moves, 2000 at most for each tool, what is deeper than {allowance:g} mm"
        rapid = Extent.SAMPLED if self._behind else Extent.PROVEN
        kinds = [
            (Phrase("cutters in rapid moves"), rapid, _WHOLE + deeper + self._behind),
            (Phrase("cutters in cutting moves"), Extent.SAMPLED, sampled),
        ]
        for subject, extent, detail in kinds:
            if self.unknown_cutters:
                detail = f"{', '.join(self.unknown_cutters)}: the diameter is not known"
                self._add(_against(subject, obstacle), Extent.NOT_COVERED, detail)
            else:
                self._add(_against(subject, obstacle), extent, _detail(obstacle, detail))

    def cutters_in_all_moves(self, obstacle: Obstacle) -> None:
        """Record the check of cutters against a fixture, if their size is known."""
        if self.unknown_cutters:
            detail = f"{', '.join(self.unknown_cutters)}: the diameter is not known"
            self._add(_against(Phrase("cutters"), obstacle), Extent.NOT_COVERED, detail)
        else:
            self._add(_against(Phrase("cutters"), obstacle), Extent.PROVEN, _detail(obstacle, _WHOLE))

    def stock(self, obstacle: Obstacle, step: float, points: int, apart: float, deeper: float) -> None:
        """Record the check of the stock by grid points, in poses that far apart, and the depth that counts, mm."""
        detail = f"as it is left by the cuts before, in {points:,} points {step:.2g} mm apart"
        detail += f", what is deeper than {deeper:.2g} mm, every {apart:.2g} mm of the way"
        self._add(Phrase("machine and rapid moves against the stock"), Extent.SAMPLED, _detail(obstacle, detail))

    def stock_open(self, obstacle: Obstacle) -> None:
        """Record that the stock is not a solid."""
        detail = _detail(obstacle, "its mesh is not closed: rapid moves were not looked at")
        self._add(Phrase("machine and rapid moves against the stock"), Extent.NOT_COVERED, detail)


def _against(subject: Phrase, obstacle: Obstacle) -> Phrase:
    source = f" {obstacle.source}" if obstacle.name == "fixture" else ""
    return Phrase("{} against the {}{}", subject, obstacle.name, source)


def _detail(obstacle: Obstacle, how: str) -> str:
    return f"{obstacle.source}, {obstacle.triangles:,} triangles, {how}"
