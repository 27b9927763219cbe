# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job set-up: part, stock and tool shanks of a CAM job, for posting and for checks.

Takes a job; returns a set-up, in mm, in the work frame {C} of the job. A job has no data on clamps. The end of the
cutting edges is known for tool bits with a CuttingEdgeHeight and a ShankDiameter, as end mills have.
The box that CAM puts around the model of a new job counts as assumed: the user did not choose it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from Path.Main.Stock import StockType

from pkm_post.freecad_app.part_mesh import mesh_of
from pkm_post.freecad_app.tools import millimetres
from pkm_post.model import Mesh, Setup, Shank


def job_setup(job: Any) -> Setup:
    """The set-up of a recomputed job."""
    shanks = dict(_shanks(job.Tools.Group))
    stock = _mesh([job.Stock] if job.Stock else [], StockType.FromStock(job.Stock) == StockType.FromBase)
    return Setup(part=_mesh(job.Model.Group), stock=stock, shanks=shanks)


def _mesh(items: Iterable[Any], assumed: bool = False) -> Mesh | None:
    """The meshes of some objects as one; None if they have no faces."""
    shaped = [item for item in items if hasattr(item, "Shape")]
    triangles = np.concatenate([np.empty((0, 3, 3)), *(mesh_of(item.Shape) for item in shaped)])
    return Mesh(", ".join(item.Label for item in shaped), triangles, assumed) if len(triangles) else None


def _shanks(controllers: Iterable[Any]) -> Iterator[tuple[int, Shank]]:
    for controller in controllers:
        start, diameter = (millimetres(controller.Tool, name) for name in ("CuttingEdgeHeight", "ShankDiameter"))
        if start > 0 and diameter > 0:
            yield int(controller.ToolNumber), Shank(start, diameter)
