# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``machine list``, ``machine check``, ``machine calibrate`` and ``machine export``."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.inputs import MACHINE, tool_length_of
from pkm_post.cli.processes import wrong_usage
from pkm_post.cli.terminal import print_diagnostics
from pkm_post.options import LONGEST_TOOL, validated, whole

if TYPE_CHECKING:
    from pkm_post.model import Diagnostics, Machine


def add_commands(commands: Any) -> None:
    """Add the commands to a parser."""
    machine = commands.add_parser("machine", help="list, check, calibrate and export machine files")
    actions = machine.add_subparsers(required=True, metavar="ACTION")
    listing = actions.add_parser("list", help="list the machines shipped with PKM Post")
    listing.set_defaults(run=_list)
    checking = actions.add_parser("check", help="check that a machine file is complete and consistent")
    checking.add_argument("file", metavar="NAME_OR_FILE", help=MACHINE)
    checking.set_defaults(run=_check)
    calibrating = actions.add_parser("calibrate", help="find the joints of a machine from measured poses")
    calibrating.add_argument("file", metavar="NAME_OR_FILE", help=MACHINE)
    calibrating.add_argument("measurements", type=Path, metavar="MEASUREMENTS.csv", help="see docs/machine-file.md")
    calibrating.add_argument("--out", required=True, type=Path, metavar="NEW.toml", help="the machine file to write")
    calibrating.add_argument(
        "--runs",
        type=whole(2, 1_000_000),
        metavar="N",
        help="repeat it with noise N times, to estimate the error of the tool tip",
    )
    calibrating.add_argument(
        "--noise",
        type=_noise,
        metavar="MM,DEG,MM",
        help="standard deviations of measured tip, axis and length (default: of the lengths alone, by their residuals)",
    )
    calibrating.set_defaults(run=_calibrate)
    exporting = actions.add_parser("export", help="write the kinematics of a machine for its controller")
    exporting.add_argument("file", metavar="NAME_OR_FILE", help=MACHINE)
    exporting.add_argument("--to", required=True, choices=_TARGETS, help="controller that computes the kinematics")
    exporting.add_argument("--out", required=True, type=Path, metavar="DIR", help="folder of the files")
    exporting.add_argument(
        "--segment-time",
        type=whole(1, 255),
        metavar="MS",
        help=f"segment time of a PMAC's coarse interpolation, 1 to 255 (default: {_SEGMENT_TIME})",
    )
    exporting.add_argument(
        "--tool-length", type=_length, metavar="MM", help="initial gauge length (default: that of the rest pose)"
    )
    help_text = "posted program for a Power PMAC project, with its set-up instead of the kinematics"
    exporting.add_argument("--program", type=Path, metavar="PROGRAM.pmc", help=help_text)
    exporting.set_defaults(run=_export)


_PROJECT = "power-pmac-project"
_TARGETS = ("turbo-pmac", "power-pmac", _PROJECT, "linuxcnc")
_SEGMENT_TIME = 10


_length = validated(float, lambda mm: 0 <= mm <= LONGEST_TOOL, f"a length of 0 to {LONGEST_TOOL} mm")
_LARGEST_NOISE = 10.0


def _noise(text: str) -> tuple[float, ...]:
    words = text.split(",")
    try:
        values = tuple(float(word) for word in words)
    except ValueError:
        values = ()
    if len(values) != 3 or not all(0.0 <= value <= _LARGEST_NOISE for value in values):
        raise argparse.ArgumentTypeError(
            f"expected MM,DEG,MM, three numbers from 0 to {_LARGEST_NOISE:g}, got {text!r}"
        )
    return values


def _list(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine import presets, templates

    print("\n".join([*presets(), *(f"{name} (template, to be copied and filled in)" for name in templates())]))
    return 0


def _check(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine import machine_named
    from pkm_post.model import errors
    from pkm_post.posting import format_table, machine_faults, machine_summary

    machine, diagnostics = machine_named(namespace.file)
    if machine is not None:
        diagnostics = machine_faults(machine, namespace.file)
    print_diagnostics(diagnostics)
    if machine is None or errors(diagnostics):
        return 1
    print(f"{machine.name}: complete")
    print(format_table(machine_summary(machine)))
    return 0


def _calibrate(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine import MeasurementNoise, Repetition, calibrate_file

    if namespace.noise and not namespace.runs:
        return wrong_usage("U102", "--noise", "--runs, how often the calibration is repeated")
    noise = None
    if namespace.noise:
        tip, angle, length = namespace.noise
        noise = MeasurementNoise(tip, math.radians(angle), length)
    repetition = Repetition(namespace.runs, noise) if namespace.runs else None
    report, diagnostics = calibrate_file(namespace.file, namespace.measurements, namespace.out, repetition)
    print_diagnostics(diagnostics)
    if report is None:
        return 1
    print(report)
    print(namespace.out)
    return 0


def _export(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine import machine_named
    from pkm_post.posting import export_machine
    from pkm_post.writing import kinematics

    if namespace.to == "linuxcnc" and namespace.segment_time is not None:
        return wrong_usage("U103", "--segment-time", "LinuxCNC has no segments")
    if namespace.program is not None and namespace.to != _PROJECT:
        return wrong_usage("U103", "--program", f"it is for --to {_PROJECT} alone")
    machine, diagnostics = machine_named(namespace.file)
    files: tuple[Path, ...] = ()
    program: tuple[str, str] | None = None
    if machine is not None and namespace.program is not None:
        program, diagnostics = _certified_program(namespace.program, machine)
    if machine is not None and (program is not None or namespace.program is None):
        length = tool_length_of(namespace, machine)
        export = kinematics.Export(namespace.segment_time or _SEGMENT_TIME, length, program=program)
        files, diagnostics = export_machine(machine, namespace.file, namespace.to, namespace.out, export)
    print_diagnostics(diagnostics)
    for file in files:
        print(file)
    return 0 if files else 1


def _certified_program(path: Path, machine: Machine) -> tuple[tuple[str, str] | None, Diagnostics]:
    """Name and text of a program that is certified for a machine, or the reasons why it is not."""
    from pkm_post.control.loading import certified

    found, faults = certified(path, machine)
    return (None, faults) if found is None else ((path.name, found.text), faults)
