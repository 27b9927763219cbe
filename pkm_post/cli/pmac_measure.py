# SPDX-License-Identifier: LGPL-2.1-or-later
"""PMAC measure: the action measure of the command ``pmac``: a touch probe finds a face, a bore or a boss."""

from __future__ import annotations

import argparse
import logging
import math
from typing import TYPE_CHECKING

from pkm_post.cli.pmac_manual import control_of
from pkm_post.cli.pmac_stop import Actions, held_at_the_end
from pkm_post.cli.processes import wrong_usage
from pkm_post.cli.terminal import print_diagnostics
from pkm_post.options import offset, positive

if TYPE_CHECKING:
    from pkm_post.cli.pmac_stop import Target
    from pkm_post.control.link import Session
    from pkm_post.control.numerical_control import Feature, Probe, ProbeInput
    from pkm_post.model import Array

FEATURES = ("face", "bore", "boss")
_ALONG = ("x-", "x+", "y-", "y+", "z-", "z+")
_NEEDED = {"face": ("along",), "bore": (), "boss": ("diameter", "depth")}
_UNKNOWN = {"face": ("diameter", "depth"), "bore": ("along", "diameter", "depth"), "boss": ("along",)}
_OVERTRAVEL_MM, _RESOLUTION_MM, _WITHIN_MM, _CLEARANCE_MM = 2.0, 0.001, 10.0, 5.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the action, except those common to manual moves."""
    parser.add_argument("feature", choices=FEATURES, help="feature to measure")
    help_text = "controller variable of the probe, and its value on contact (M1000=1)"
    parser.add_argument("--input", required=True, type=_input, metavar="VARIABLE[=0|1]", help=help_text)
    parser.add_argument("--ball", required=True, type=positive, metavar="MM", help="diameter of the probe ball")
    parser.add_argument("--along", choices=_ALONG, help="direction towards a face, in the work frame")
    help_text = "longest distance to a contact with a face or in a bore (%(default)s)"
    parser.add_argument("--within", type=positive, default=_WITHIN_MM, metavar="MM", help=help_text)
    parser.add_argument("--diameter", type=positive, metavar="MM", help="approximate diameter of a boss")
    parser.add_argument("--depth", type=positive, metavar="MM", help="depth below the probe at which a boss is touched")
    help_text = "distance from a boss at which the probe goes down (%(default)s)"
    parser.add_argument("--clearance", type=positive, default=_CLEARANCE_MM, metavar="MM", help=help_text)
    help_text = "permitted overtravel of the probe beyond a contact; determines the feed (%(default)s)"
    parser.add_argument("--overtravel", type=positive, default=_OVERTRAVEL_MM, metavar="MM", help=help_text)
    help_text = "resolution of a contact (%(default)s)"
    parser.add_argument("--resolution", type=positive, default=_RESOLUTION_MM, metavar="MM", help=help_text)
    help_text = "work offset whose axes are used (%(default)s)"
    parser.add_argument("--work-offset", default="G54", metavar="NAME", help=help_text)
    help_text = "required coordinates of the feature: one for a face, X,Y for a bore or a boss (zero)"
    parser.add_argument("--at", type=_coordinates, metavar="MM[,MM]", help=help_text)


def _input(text: str) -> ProbeInput:
    from pkm_post.control.numerical_control import ProbeInput

    try:
        return ProbeInput.from_text(text)
    except ValueError as fault:
        raise argparse.ArgumentTypeError(str(fault)) from None


def _coordinates(text: str) -> tuple[float, ...]:
    return tuple(offset(word) for word in text.split(","))


def measure(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Measure a feature and print it, with the resulting work offset."""
    from pkm_post.control.numerical_control import Probe, ProbeSettings
    from pkm_post.options import Options
    from pkm_post.posting import work_offset

    work, faults = work_offset(target.machine, Options(work_offset=namespace.work_offset))
    lacks = needs(namespace)
    if lacks:
        return wrong_usage("U103", "pmac measure", lacks)
    if work is None:
        print_diagnostics(faults)
        return 1
    logging.getLogger().setLevel(logging.WARNING)  # each of the many moves would log its download
    control = control_of(session, target, namespace)
    settings = ProbeSettings(namespace.input, namespace.ball, namespace.overtravel, namespace.resolution)
    probe = Probe(session, control, settings, control.longest_silence_s())
    print(
        f"at {60 * probe.feed:.1f} mm/min; a contact pushes the probe by less than {settings.overtravel:g} mm",
        flush=True,
    )
    with held_at_the_end(session, target.settings):
        found = _measured(probe, work, namespace)
    _print_feature(found, work, namespace)
    return 0


def needs(namespace: argparse.Namespace) -> str:
    """Missing arguments of a feature, as text; empty if none."""
    feature = namespace.feature
    lacking = [name for name in _NEEDED[feature] if getattr(namespace, name) is None]
    foreign = [name for name in _UNKNOWN[feature] if getattr(namespace, name) is not None]
    count = 1 if feature == "face" else 2
    if namespace.at is not None and len(namespace.at) != count:
        return f"{feature}: expected {count} in --at, got {len(namespace.at)}"
    if lacking:
        return f"{feature}: expected --{' and --'.join(lacking)}"
    return f"{feature}: expected no --{' and no --'.join(foreign)}" if foreign else ""


def _measured(probe: Probe, work: Array, namespace: argparse.Namespace) -> Feature:
    from pkm_post.control.numerical_control import measure_bore, measure_boss, measure_face

    if namespace.feature == "face":
        return measure_face(probe, work, namespace.along, namespace.within)
    if namespace.feature == "bore":
        return measure_bore(probe, work, namespace.within)
    return measure_boss(probe, work, namespace.diameter, namespace.depth, namespace.clearance)


def _print_feature(found: Feature, work: Array, namespace: argparse.Namespace) -> None:
    import numpy as np

    from pkm_post.control.numerical_control import origin_for

    measured = ~np.isnan(found.position)
    nominal = np.zeros(3)
    nominal[measured] = namespace.at or 0.0
    origin = origin_for(found, work, nominal)
    sizes = [f", diameter {size:.4f} along {letter}" for size, letter in zip(found.diameters, "XY", strict=False)]
    print(f"{namespace.feature}: {_axes(found.position)}{''.join(sizes)} in {namespace.work_offset}, mm")
    print(f"each contact within {found.half_width:.4f} mm")
    wanted = _axes(np.where(measured, nominal, np.nan))
    print(f"for {wanted} the origin of {namespace.work_offset} goes by {_axes(origin - work[:3, 3])} in {{M}}")
    if work[2, 2] == 1.0:
        turn = math.degrees(math.atan2(work[1, 0], work[0, 0]))
        print(f"to post with it: --work-offset={','.join(f'{value:z.4f}' for value in (*origin, turn))}")


def _axes(point: Array) -> str:
    return " ".join(f"{letter}{mm:z.4f}" for letter, mm in zip("XYZ", point, strict=True) if not math.isnan(mm))


ACTIONS: Actions = {
    "measure": (measure, "measure a face, a bore or a boss with a touch probe", ("machine",)),
}
