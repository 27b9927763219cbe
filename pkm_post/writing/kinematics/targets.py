# SPDX-License-Identifier: LGPL-2.1-or-later
"""Targets: the files of an export, by controller.

Input: a machine, the settings of the export, and positions with their strut lengths. Output: names and texts of files,
or diagnostics.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from pkm_post.model import Diagnostic, Diagnostics, Machine, Place
from pkm_post.writing.controllers import power_pmac, power_project
from pkm_post.writing.controllers.pmac.settings import PmacSettings
from pkm_post.writing.controllers.power_pmac import PowerPmacSettings
from pkm_post.writing.controllers.pvt.settings import settings_of
from pkm_post.writing.kinematics import linuxcnc
from pkm_post.writing.kinematics.controller_file import Export, counts, power_text, turbo_text
from pkm_post.writing.kinematics.linuxcnc import stream_hal
from pkm_post.writing.kinematics.sign_off import CheckPoses, linuxcnc_sheet, sign_off_sheet

Files = Mapping[str, str]
Target = Callable[[Machine, str, Export, CheckPoses], tuple[Files | None, Diagnostics]]
"""Names, with one stem, and texts of the files, or None with diagnostics."""
SIGN_OFF = "-sign-off.md"


def _pmac(
    form: type[Any], write: Callable[..., str], target: str, suffix: str,
    machine: Machine, stem: str, export: Export, poses: CheckPoses,
) -> tuple[Files | None, Diagnostics]:  # fmt: skip
    """The kinematic file and the sheet for the PMAC that the machine file names."""
    of_kind = replace(machine, controller={**machine.controller, "kind": form.KIND})
    settings, faults = settings_of(form, of_kind)
    if settings is None:
        return None, faults
    text = write(machine, settings, export)
    longest = max(len(line) for line in text.splitlines())
    if longest > settings.line_limit:
        found = f"controller.line_limit: lines of the kinematics have {longest} characters, got {settings.line_limit}"
        return None, (Diagnostic("M106", Place(machine.name), found),)
    rows = [[round(count) for count in counts(settings, row)] for row in poses.lengths.tolist()]
    files = {f"{stem}{suffix}": text}
    sheet = sign_off_sheet(machine, target, digests(files), poses, rows, export.segment_time, operations(text))
    return {**files, f"{stem}{SIGN_OFF}": sheet}, ()


def digests(files: Files) -> dict[str, str]:
    """SHA-256 of files by name, hexadecimal."""
    return {name: hashlib.sha256(text.encode("utf-8")).hexdigest() for name, text in files.items()}


_OPERATION = re.compile(r"[-+*/=]|[a-zA-Z]{3,}\d?(?=\()")
"""An operator, an assignment or a function."""


def operations(text: str) -> int:
    """Operations of one run of the inverse program, without speeds."""
    body = re.split(r"(?im)^open inverse$|^close$", text)[-2]
    without_speeds = re.sub(r"(?ms)^IF .*?^ENDIF|^if .*?^}", "", body)
    return sum(len(_OPERATION.findall(re.split(";|//", line)[0])) for line in without_speeds.splitlines())


def _linuxcnc(machine: Machine, stem: str, export: Export, poses: CheckPoses) -> tuple[Files | None, Diagnostics]:
    """The configuration for genhexkins, the gate for halstreamer's tables, and the sheet."""
    stem = re.sub(r"[^\w.-]+", "_", stem)  # LinuxCNC takes what follows a blank in HALFILE for arguments
    files = {
        f"{stem}.ini": linuxcnc.ini_text(machine, stem, export.home_lengths, export.tool_length),
        f"{stem}-kinematics.hal": linuxcnc.kinematics_hal(machine),
        f"{stem}-simulated-drives.hal": linuxcnc.simulated_drives_hal(),
        f"{stem}-stream.hal": stream_hal(),
        f"{stem}.tbl": linuxcnc.tool_table(machine, export.tool_length),
    }
    return {**files, f"{stem}{SIGN_OFF}": linuxcnc_sheet(machine, digests(files), poses)}, ()


def _power_project(machine: Machine, stem: str, export: Export, poses: CheckPoses) -> tuple[Files | None, Diagnostics]:
    """A project for the IDE: with a program of strut lengths and its set-up, else with the kinematics."""
    if export.program is None:
        made, faults = TARGETS["power-pmac"](machine, stem, export, poses)
        if made is None:
            return None, faults
        routines = {f"{power_project.KINEMATICS}/{stem}-kinematics.kin": made[f"{stem}-kinematics.cfg"]}
        return power_project.project_files(stem, routines, made[f"{stem}{SIGN_OFF}"]), faults
    settings, faults = settings_of(PowerPmacSettings, machine)
    if settings is None:
        return None, faults
    name, text = export.program
    setup = power_pmac.setup_text(settings, machine.name, machine.strut_stroke)
    scripts = {f"{power_project.INCLUDES}/{stem}-setup.pmh": setup, f"{power_project.MOTION}/{name}": text}
    note = (
        f"Program {settings.program} of strut lengths for {machine.name}, with the set-up it needs.\n"
        f"SHA-256 of {name}: {hashlib.sha256(text.encode('utf-8')).hexdigest()}\n"
        "Before it is started, pkm-post pmac run lists the program in the controller and compares it.\n"
    )
    return power_project.project_files(stem, scripts, note), faults


PROJECT = "power-pmac-project"
TARGETS: dict[str, Target] = {
    "turbo-pmac": partial(_pmac, PmacSettings, turbo_text, "turbo-pmac", "-kinematics.pmc"),
    "power-pmac": partial(_pmac, PowerPmacSettings, power_text, "power-pmac", "-kinematics.cfg"),
    PROJECT: _power_project,
    "linuxcnc": _linuxcnc,
}
"""Writers by the value of ``--to``; the files of ``PROJECT`` are in folders."""
