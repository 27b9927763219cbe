# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes for the tests, their triangles turned outwards, and the STL files that hold them."""

import numpy as np

_CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
     [1, 5, 7], [1, 7, 3]]
)  # fmt: skip


def box(lowest, highest):
    """The twelve triangles of a box."""
    return (_CORNERS * (np.asarray(highest, dtype=float) - lowest) + lowest)[_FACES]


def ball(centre, radius, steps=24):
    """A ball whose corners lie on the sphere."""
    polar, around = np.linspace(0, np.pi, steps + 1), np.linspace(0, 2 * np.pi, 2 * steps + 1)
    x, y = (np.sin(polar)[:, None] * np.cos(around), np.sin(polar)[:, None] * np.sin(around))
    points = np.stack([x, y, np.broadcast_to(np.cos(polar)[:, None], x.shape)], axis=-1)
    points[:, -1], points[0], points[-1] = points[:, 0], [0, 0, 1], [0, 0, -1]
    points = points * radius + np.asarray(centre, dtype=float)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    every = np.concatenate(
        [np.stack([a, b, c], axis=-2).reshape(-1, 3, 3), np.stack([a, c, d], axis=-2).reshape(-1, 3, 3)]
    )
    return every[np.linalg.norm(np.cross(every[:, 1] - every[:, 0], every[:, 2] - every[:, 0]), axis=1) > 1e-9]


def binary_stl(triangles):
    """The bytes of a binary STL file."""
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records = np.zeros(len(triangles), record)
    records["corners"] = triangles
    return b"solid in name alone".ljust(80) + len(triangles).to_bytes(4, "little") + records.tobytes()


def ascii_stl(triangles):
    """The bytes of an ASCII STL file."""
    lines = ["solid of the tests"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "  outer loop"]
        lines += ["    vertex {!r} {!r} {!r}".format(*corner) for corner in triangle.tolist()]
        lines += ["  endloop", "endfacet"]
    return ("\n".join([*lines, "endsolid of the tests"]) + "\n").encode()
