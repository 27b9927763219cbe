# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``reach-map``: feasible tool tilt over the work volume of a machine."""

from __future__ import annotations

import argparse
import math
import os
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from pkm_post.options import number, offset, positive, tool_length, validated

_angle = validated(number, lambda degrees: 0 < degrees < 180, "an angle above 0 and below 180")

_MOST_PLACES = 1_000_000
"""A file with this many is some tens of megabytes."""


def add_commands(commands: Any) -> None:
    """Add the command to a parser."""
    mapping = commands.add_parser("reach-map", help="how far the tool may lean at each place of the work volume")
    mapping.add_argument("machine", metavar="NAME_OR_FILE")
    mapping.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="folder for the CSV and the picture")
    mapping.add_argument(
        "--length", type=tool_length, default=120.0, metavar="MM", help="gauge length (default: %(default)s)"
    )
    for name, default in (("x", "-300:300:50"), ("y", "-300:300:50"), ("z", "0:500:100")):
        mapping.add_argument(f"--{name}", type=_range, default=default, metavar="FROM:TO:STEP", help="mm, %(default)s")
    mapping.add_argument("--widest", type=_angle, default=60.0, metavar="DEG", help="largest angle (%(default)s)")
    mapping.set_defaults(run=_map)


def _range(text: str) -> list[float]:
    words = text.split(":")
    if len(words) != 3:
        raise argparse.ArgumentTypeError(f"expected FROM:TO:STEP, got {text!r}")
    first, last, step = offset(words[0]), offset(words[1]), positive(words[2])
    steps = (last - first) / step * (1 + 1e-12)
    if not 0 <= steps < _MOST_PLACES:
        raise argparse.ArgumentTypeError(f"expected FROM:TO:STEP with 1 to {_MOST_PLACES} places, got {text!r}")
    return [first + place * step for place in range(math.floor(steps) + 1)]


def _map(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    import numpy as np

    from pkm_post.machine import machine_named, reach_map
    from pkm_post.report import draw_reach
    from pkm_post.system import staged, write_fault

    if math.prod(map(len, (namespace.x, namespace.y, namespace.z))) > _MOST_PLACES:
        print(f"expected --x, --y and --z with at most {_MOST_PLACES} places together", file=sys.stderr)
        return 2
    machine, faults = machine_named(namespace.machine)
    for fault in faults:
        print(fault, file=sys.stderr)
    if machine is None:
        return 1
    grid = np.meshgrid(namespace.x, namespace.y, namespace.z, indexing="ij")
    places = np.column_stack([column.ravel() for column in grid])
    with ThreadPoolExecutor(min(os.cpu_count() or 1, 8)) as executor:
        found = reach_map(machine, places, namespace.length, math.radians(namespace.widest), executor=executor)
    stem = f"{Path(namespace.machine).stem}-reach"
    try:
        with staged(namespace.out) as folder:
            (folder / f"{stem}.csv").write_text(found.as_csv(), encoding="ascii", newline="\n")
            for warning in draw_reach(folder / f"{stem}.png", machine.name, found.tip, found.cone):
                print(warning, file=sys.stderr)
            names = sorted(path.name for path in folder.iterdir())
    except OSError as fault:
        print(write_fault(namespace.out, fault), file=sys.stderr)
        return 1
    for name in names:
        print(namespace.out / name)
    return 0
