# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs on parts of a given shape, with a given cutter; and the example of the tapered column as a module."""

import importlib.util
import sys
from pathlib import Path

import FreeCAD as App
import Path.Main.Job as CamJob
from test_tools import stock_bit

from pkm_post.freecad_app.tools import set_gauge_length

ROOT = Path(__file__).resolve().parents[2]


def load_example():
    spec = importlib.util.spec_from_file_location("tapered_column_shape", ROOT / "examples/tapered_column/build.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def job_on(document, shape, bit="ballend.fcstd", **sizes):
    """A job on a part of this shape, with a ball end mill D10 unless another cutter is given."""
    part = document.addObject("Part::Feature", "Part")
    part.Shape = shape
    job = CamJob.Create("Job", [part], None)
    controller = job.Tools.Group[0]
    controller.Tool = stock_bit(document, bit, **({"Diameter": 10} | sizes))
    controller.SpindleSpeed, controller.SpindleDir = 9000, "Forward"
    controller.HorizFeed, controller.VertFeed = "1200 mm/min", "300 mm/min"
    set_gauge_length(controller, 120)
    return job


def corner(diameter, radius):
    """The size that says the corner of a bull nose in this FreeCAD."""
    return {"FlatRadius": diameter / 2 - radius} if int(App.Version()[1]) == 0 else {"CornerRadius": radius}
