# SPDX-License-Identifier: LGPL-2.1-or-later
"""Search: collision checks of the machine and its tools with the set-up, body by body.

Takes the path of the machine and a set-up; returns diagnostics and coverage rows. Distances refer to the programmed
trajectory; the allowed deviation of the tool from it is added to clearances and allowances. Units: mm, rad.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from pkm_post.geometry import Array, is_closed
from pkm_post.machine.collisions.contacts import (
    ENOUGH,
    Obstacle,
    TrajectoryPath,
    contact_faults,
    contacts,
    contacts_at_ends,
    mesh_faults,
)
from pkm_post.machine.collisions.coverage import FIXTURES_NOT_KNOWN, PART_NOT_KNOWN, STOCK_NOT_KNOWN, CoverageRows
from pkm_post.machine.collisions.moving_bodies import (
    MovingBody,
    ToolCylinder,
    cutter_hull,
    cutter_pieces,
    platform_body,
    shank_pieces,
    strut_bodies,
    tool_body,
)
from pkm_post.machine.collisions.stock_collisions import (
    Intruder,
    body_of,
    points_met,
    rapid_cutter,
    shank_of,
    stock_faults,
)
from pkm_post.machine.collisions.tools_in_use import ToolUse, not_cut_before, tools_in_use
from pkm_post.machine.kinematics.placed_machine import has_strut_bodies
from pkm_post.model import Diagnostic, Machine, Mesh, Phrase, Place, Setup, Tolerances

ALLOWANCE = 0.25
"""mm that a cutter or a shank may enter the workpiece: its faces are triangulated, and the cutter must touch them."""
_TOUCH = 1e-3
"""mm: bodies without clearance collide where they are closer than this."""
_SAMPLES = 2000
"""Sampled poses of cutting moves."""
_ALL = 1_000_000


@dataclass
class Search:
    """The checks, to be called in the order of their definition.

    Attributes:
        driven: the path.
        setup: workpiece, stock and fixtures.
        tolerances: allowed deviation of the tool from the path.
        found: errors and warnings so far.
        extents: checks made so far.
    """

    driven: TrajectoryPath
    machine: Machine
    setup: Setup
    tolerances: Tolerances
    found: list[Diagnostic] = field(default_factory=list)
    extents: CoverageRows = field(default_factory=CoverageRows)

    def __post_init__(self) -> None:
        path = self.driven.poses
        self.used = tools_in_use(self.driven, self.setup)
        self.bodies = [platform_body(self.machine, path, body) for body in self.machine.bodies]
        self.struts = strut_bodies(self.machine, path) if has_strut_bodies(self.machine) else None
        self.off_tip = float(self.driven.trajectory.tip_tolerances(self.tolerances.tip).max())

    def part(self) -> None:
        """Check everything that moves against the finished workpiece."""
        if self.setup.part is None:
            self.extents.not_known(PART_NOT_KNOWN)
            return
        part = self._obstacle(Phrase("part"), self.setup.part)
        self._machine(part, "K117", "K121")
        for _, mover in self._shank_movers(ALLOWANCE + self.off_tip):
            self.found += mesh_faults(self.driven, "K130", mover, part, _TOUCH)
        self._note_shanks(part)
        for used in self._with_size(part):
            pieces = cutter_pieces(used.tool, used.edge_length, ALLOWANCE + self.off_tip)
            if pieces:  # else no point of the cutter is that deep in it
                self._rapid(part, used, pieces)
                self._cutting(part, used, pieces)
        self.extents.cutters(part, ALLOWANCE)

    def _cutting(self, part: Obstacle, used: ToolUse, pieces: Sequence[ToolCylinder]) -> None:
        """Check the pieces of a cutter against the workpiece at poses of its cutting moves."""
        # Few of many poses are so near that the many pieces of a slanted cutter matter.
        around = [ToolCylinder(0.0, used.edge_length, max(piece.radius + piece.rounding for piece in pieces))]
        mover = tool_body(used.name, self.driven.poses, _sampled(used.cutting), around)
        cells = contacts_at_ends(self.driven.poses, mover, part.mesh, _TOUCH).cell
        mover = tool_body(used.name, self.driven.poses, cells, pieces)
        met = contacts_at_ends(self.driven.poses, mover, part.mesh, _TOUCH)
        self.found += contact_faults(self.driven, "K132", mover, part, met, ALLOWANCE)

    def _rapid(self, part: Obstacle, used: ToolUse, pieces: Sequence[ToolCylinder]) -> None:
        """Check the pieces of a cutter against the workpiece in rapid moves, except where material was cut before."""
        mover = tool_body(Phrase("{} in a rapid move", used.name), self.driven.poses, used.rapid, pieces)
        met = contacts(self.driven.poses, mover, part.mesh, _TOUCH, self.driven.operation, _ALL)
        uncut = not_cut_before(self.driven, self.used, met)
        if len(uncut) < len(met):
            # Finishing cut the surface there, which says nothing of the material behind it.
            assert self.setup.part is not None
            grid, inside = points_met(self.driven, self.setup.part, rapid_cutter(used), ALLOWANCE + self.off_tip)
            self.extents.points_behind(grid)
            uncut = uncut.joined(not_cut_before(self.driven, self.used, inside))
        self.found += contact_faults(self.driven, "K131", mover, part, uncut, ALLOWANCE)

    def fixtures(self) -> None:
        """Check everything that moves against the fixtures, in all moves."""
        if not self.setup.fixtures:
            self.extents.not_known(FIXTURES_NOT_KNOWN)
        for mesh in self.setup.fixtures:
            fixture = self._obstacle(Phrase("fixture"), mesh)
            self._machine(fixture, "K133", "K133")
            movers = [mover for _, mover in self._shank_movers(0.0)]
            self._note_shanks(fixture)
            for used in self._with_size(fixture):
                pieces = cutter_hull(used.largest, used.edge_length)
                movers.append(tool_body(used.name, self.driven.poses, used.cells(), pieces))
            for mover in movers:
                self.found += mesh_faults(self.driven, "K133", mover, fixture, _TOUCH + self._off_path(mover))
            self.extents.cutters_in_all_moves(fixture)

    def stock(self) -> None:
        """Check the stock against bodies, struts and shanks in all moves, and against cutters in rapid moves."""
        mesh = self.setup.stock
        if mesh is None:
            self.extents.not_known(STOCK_NOT_KNOWN)
            return
        stock = self._obstacle(Phrase("stock"), mesh)
        closed = is_closed(mesh.triangles)
        if not closed:
            self.found.append(Diagnostic("K139", Place(mesh.source), Phrase("{} triangles", len(mesh.triangles))))
        intruders = [*self._in_stock(stock, closed)]
        intruders += [rapid_cutter(used) for used in self.used if used.has_size and len(used.rapid)]
        if closed and intruders:
            grid, apart, deeper, found = stock_faults(self.driven, mesh, intruders, self.used, self.off_tip)
            self.found += found
            self.extents.stock(stock, grid.step, int(grid.filled.sum()), apart, deeper)
        elif not closed:
            self.extents.stock_open(stock)

    def _in_stock(self, stock: Obstacle, closed: bool) -> Iterator[Intruder]:
        """Movers not proven to stay clear of the uncut stock."""
        movers: list[tuple[MovingBody, Intruder | None]] = [
            (mover, body_of(self.machine, body, self.used))
            for mover, body in zip(self.bodies, self.machine.bodies, strict=True)
        ]
        movers += [(mover, shank_of(used)) for used, mover in self._shank_movers(0.0)]
        movers += [(self.struts, None)] if self.struts else []
        for mover, intruder in movers:
            in_points = closed and intruder is not None
            operation, enough = self.driven.operation, 1 if in_points else ENOUGH
            clearance = _TOUCH + self._off_path(mover)
            met = contacts(self.driven.poses, mover, stock.mesh, clearance, operation, enough)
            if len(met) and closed and intruder is not None:
                yield intruder
            elif len(met):
                self.found += contact_faults(self.driven, "K135", mover, stock, met, 0.0)

    def _obstacle(self, name: Phrase, mesh: Mesh) -> Obstacle:
        return Obstacle.of(name, mesh, self.driven.trajectory.machine_from_work)

    def _machine(self, obstacle: Obstacle, of_bodies: str, strut_bodies: str) -> None:
        """Check bodies of the platform and struts against a mesh."""
        movers: Sequence[tuple[str, MovingBody]] = [(of_bodies, mover) for mover in self.bodies]
        movers = [*movers, (strut_bodies, self.struts)] if self.struts else movers
        for code, mover in movers:
            clearance = self.machine.clearance + self._off_path(mover)
            self.found += mesh_faults(self.driven, code, mover, obstacle, max(clearance, _TOUCH))
        self.extents.machine(obstacle, bool(self.bodies), self.struts is not None)

    def _off_path(self, mover: MovingBody) -> float:
        """Largest distance of a point of a mover from where the programmed path has it."""
        return self.off_tip + self.tolerances.axis * mover.reach

    def _note_shanks(self, obstacle: Obstacle) -> None:
        self.extents.shanks(obstacle, [used.name for used in self.used if used.shank is None])

    def _shank_movers(self, less: float) -> Iterator[tuple[ToolUse, MovingBody]]:
        """The known shanks, reduced by a distance on all sides."""
        for used in self.used:
            pieces = () if used.shank is None else shank_pieces(used.tool, used.shank, less)
            if pieces:
                yield used, tool_body(Phrase("shank of {}", used.name), self.driven.poses, used.cells(), pieces)

    def _with_size(self, obstacle: Obstacle) -> Iterator[ToolUse]:
        """The tools whose cutters are known; the others are recorded in the coverage."""
        self.extents.unknown_cutters = [used.name for used in self.used if not used.has_size]
        return (used for used in self.used if used.has_size)


def _sampled(cells: Array) -> Array:
    """A subset of many cells, evenly chosen, including the last one."""
    if len(cells) <= _SAMPLES:
        return cells
    return cells[np.linspace(0, len(cells) - 1, _SAMPLES).astype(np.int64)]
