# SPDX-License-Identifier: LGPL-2.1-or-later
"""Transformation: a program mirrored, rotated or shifted, and copies of a program concatenated.

Takes a program and a matrix T_C, both in the work frame {C}: q' = T_C q, k' = R k [paper eq. 12, 13]. The axis of an
arc is an axial vector: it becomes det(R) R axis, so a mirror reverses the sense of arcs while each stays right-handed
about its axis.

The order of the rows, and so the order of cuts, is kept. Spindle events keep their sense, because the mirror image of a
right-hand cutter would be a left-hand one: a mirror turns climb milling into conventional milling.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pkm_post.geometry import Array, norm, unit, unit_or_nan
from pkm_post.model import PROGRAM_COLUMNS, Diagnostic, Diagnostics, Phrase, Place, Program, map_rows

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_RIGID = 1e-6
"""Largest deviation of R^T R from identity, and of the last row from 0 0 0 1: matrices are typed with six decimals."""


def mirror(point: ArrayLike, normal: ArrayLike) -> Array:
    """The reflection at a plane, (4, 4): q' = q - 2 n n.(q - p).

    Args:
        point: (3,) a point p of the plane, mm.
        normal: (3,) direction of its normal n, of any length above zero.

    Raises:
        ValueError: the normal has no direction.
    """
    n = unit(np.asarray(normal, dtype=np.float64))
    return _about(point, np.eye(3) - 2 * np.outer(n, n))


def rotation(point: ArrayLike, axis: ArrayLike, angle: float) -> Array:
    """The right-handed rotation about a line, (4, 4).

    Args:
        point: (3,) a point of the line, mm.
        axis: (3,) direction of the line, of any length above zero.
        angle: rad.

    Raises:
        ValueError: the axis has no direction.
    """
    x, y, z = unit(np.asarray(axis, dtype=np.float64))
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return _about(point, np.eye(3) + np.sin(angle) * across + (1 - np.cos(angle)) * (across @ across))


def mirrors(matrix: ArrayLike) -> bool:
    """Whether the matrix changes handedness: climb milling becomes conventional milling, and vice versa.

    Args:
        matrix: (4, 4) homogeneous matrix.

    Raises:
        ValueError: the matrix is not (4, 4).
    """
    return bool(np.linalg.det(_matrix(matrix)[:3, :3]) < 0)


def transform(program: Program, matrix: ArrayLike) -> tuple[Program | None, Diagnostics]:
    """The program transformed by the matrix, or the faults of the matrix.

    Args:
        program: cutter locations in {C}.
        matrix: (4, 4) homogeneous matrix T_C: rotation or mirror, and translation in mm.

    Raises:
        ValueError: the matrix is not (4, 4).
    """
    matrix = _matrix(matrix)
    fault = _fault(matrix)
    if fault:
        return None, (Diagnostic("K109", Place(program.source), fault),)
    turn, shift = matrix[:3, :3], matrix[:3, 3]
    hand = np.sign(np.linalg.det(turn))
    plane, side_offset = _compensation(program, turn, hand)
    if plane is None:
        return None, (
            Diagnostic("K112", Place(program.source), Phrase("the plane is not parallel to two axes any more")),
        )
    moved = dataclasses.replace(
        program,
        position=map_rows(lambda points: _turned(points, turn) + shift, program.position),
        tool_axis=map_rows(lambda axes: unit(_turned(axes, turn)), program.tool_axis),
        arc_centre=map_rows(lambda points: _turned(points, turn) + shift, program.arc_centre),
        arc_axis=map_rows(lambda axes: unit_or_nan(_turned(axes, hand * turn)), program.arc_axis),
        side_offset=side_offset,
        plane=plane,
        normal=map_rows(lambda normals: _turned(normals, turn), program.normal),
        # A mirror M takes the platform to M R M, which reverses the rotation about the tool axis.
        spin=map_rows(lambda spin: hand * spin, program.spin),
    )
    return moved, ()


def _turned(vectors: Array, turn: Array) -> Array:
    """(N, 3) vectors times a (3, 3) matrix, without the threads of a large matrix product."""
    return np.einsum("nj,ij->ni", vectors, turn)


def _compensation(program: Program, turn: Array, hand: float) -> tuple[Array | None, Array]:
    """Plane and side offset of the transformed rows, (N,) each; no plane if a compensated one becomes oblique.

    Left of a path with tangent t is n x t, n the normal of the plane in the sense of its coordinate. R (n x t) =
    det(R) Rn x Rt, so the side changes with the sign of det(R) times that of Rn along its new coordinate.
    """
    normal_to = np.argmax(np.abs(turn), axis=0)  # per plane; the columns of ``turn`` are the new normals
    along = turn[normal_to, np.arange(3)]
    plane = map_rows(lambda planes: normal_to[planes], program.plane)
    if not program.side_offset.any():
        return plane, program.side_offset
    if np.any((np.abs(along) < 1 - _RIGID)[program.plane] & (program.side_offset != 0)):
        return None, program.side_offset
    return plane, program.side_offset * (np.sign(along) * hand)[program.plane]


def _about(point: ArrayLike, turn: Array) -> Array:
    """The (4, 4) matrix that applies (3, 3) ``turn`` and keeps ``point`` fixed."""
    fixed = np.asarray(point, dtype=np.float64)
    matrix = np.eye(4)
    matrix[:3, :3] = turn
    matrix[:3, 3] = fixed - turn @ fixed
    return matrix


def _matrix(matrix: ArrayLike) -> Array:
    checked = np.asarray(matrix, dtype=np.float64)
    if checked.shape != (4, 4):
        raise ValueError(f"expected a matrix (4, 4), got {checked.shape}")
    return checked


def _fault(matrix: Array) -> str:
    """The reason why the matrix is not rigid, or an empty string."""
    if not np.all(np.isfinite(matrix)):
        return "it has elements that are no finite number"
    if np.max(np.abs(matrix[3] - [0, 0, 0, 1])) > _RIGID:
        return f"its last row is {' '.join(f'{value:g}' for value in matrix[3])}, not 0 0 0 1"
    columns = matrix[:3, :3]
    excess = columns.T @ columns - np.eye(3)
    if np.max(np.abs(np.diag(excess))) > _RIGID:
        return f"it scales by {' '.join(f'{length:.6g}' for length in norm(columns.T))}"
    if np.max(np.abs(excess)) > _RIGID:
        return "its axes are not at right angles"
    return ""


def concatenate(programs: Sequence[Program]) -> Program:
    """Concatenate programs that share operations, tools and source, as copies do.

    Args:
        programs: at least one; each is reached from the one before by its first rapid move.

    Raises:
        ValueError: there are no programs, or their operations differ.
    """
    if not programs or any(program.operations != programs[0].operations for program in programs):
        raise ValueError("concatenate: expected programs of the same operations, at least one")
    first_rows = np.cumsum([0, *map(len, programs)])
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(program, name) for program in programs]) for name in PROGRAM_COLUMNS
    }
    return dataclasses.replace(
        programs[0],
        **columns,
        events=tuple(
            dataclasses.replace(event, row=int(first) + event.row)
            for first, program in zip(first_rows, programs, strict=False)
            for event in program.events
        ),
    )
