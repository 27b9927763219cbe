# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cartesian form: a certified program of strut lengths as a program of tip and axis, for kinematics in the controller.

In PVT mode the controller runs its inverse program once per point, with the rates of the axes, and moves each motor on
a cubic between two points [Turbo PMAC User Manual, p. 265 and 266; Power PMAC User's Manual, p. 518 and 519], as in a
program of strut lengths. So the new program has the same points and times, X Y Z in mm and A B C in degrees in {M}. A
Power PMAC with segmentation plays other curves, through points at whole segments (``cartesian_segments``). The program
is read back from its text, run through the kinematics, and certified by the resulting strut motion. A Power PMAC uses
doubles, as we do, a Turbo PMAC 36 bits: its lengths differ by less than 2e-7 mm (docs/controller-kinematics.md). A
guard ends the program where the kinematics are off, or the tool, work frame or segment time is not the certified one.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pkm_post.model import Certificate, Diagnostic, Machine, Refused, StrutMotion, Trajectory, required
from pkm_post.posting.cartesian_axes import axis_motion, strut_motion
from pkm_post.posting.cartesian_check import axis_controller, certify_axes, planned_of_one_tool, read_axes
from pkm_post.posting.cartesian_guard import POWER_REASONS, Allowance, Setting, guard_lines, guarded
from pkm_post.posting.cartesian_segments import on_segments
from pkm_post.posting.verify import read_motion, verify
from pkm_post.report import summary
from pkm_post.system import require_other, staged, write_fault
from pkm_post.writing import PmacSettings, PowerPmacSettings, kinematics, manifest, outputs, program_files


class CartesianProgram(NamedTuple):
    """A program of tip and axis with the posted motion.

    Attributes:
        files: its parts.
        certificate: its certificate, which holds.
        off: largest strut difference from the program of strut lengths at its points, mm.
    """

    files: tuple[Path, ...]
    certificate: Certificate
    off: float


def cartesian_program(
    program: Path,
    trajectory: Path,
    machine: Machine,
    out: Path,
    allowance: Allowance | None = None,
    segment_time: int = 0,
) -> CartesianProgram:
    """Write a program in X Y Z A B C with the strut motion of a posted one.

    Args:
        program: the motion program, or the first of its parts.
        trajectory: the trajectory file it was made from.
        machine: the machine it was made for.
        out: the file to write; further parts go beside it.
        allowance: permitted changes at the machine; none by default.
        segment_time: of a Power PMAC (``Coord[].SegMoveTime``), whole ms; 0 without segmentation.

    Raises:
        Refused: a file cannot be read, the certificate of either program does not hold, controller or tools do
            not allow the form, or the folder is not writable.
    """
    controller, settings = axis_controller(machine, segment_time)
    verify(program, trajectory, machine)
    planned = planned_of_one_tool(trajectory, program.name)
    source = _Source(read_motion(program, machine), trajectory, planned, machine, controller, settings)
    setting = Setting(source.tool_length, allowance or Allowance(), segment_time)
    try:
        require_other(out, [program, trajectory])
        with staged(out.parent) as folder:
            return source.written(folder / out.name, out, setting)
    except OSError as fault:
        raise Refused([write_fault(out, fault)]) from fault


def write_cartesian(file: Path, struts: StrutMotion, trajectory: Path, machine: Machine) -> float:
    """Write a certified motion in this form, beside its other results.

    Args:
        file: the file to write; further parts go beside it.
        struts: the motion as read back.
        trajectory: the trajectory file it was made from.
        machine: the machine it was made for.

    Returns:
        The largest difference of a strut at a point, mm.

    Raises:
        Refused: as ``cartesian_program``.
    """
    planned = planned_of_one_tool(trajectory, file.name)
    source = _Source(struts, trajectory, planned, machine, *axis_controller(machine, 0))
    return source.written(file, file, Setting(source.tool_length, Allowance())).off


@dataclass(frozen=True)
class _Source:
    """A posted motion with its trajectory, machine and controller.

    Attributes:
        file: its trajectory file.
        planned: content of that file; all tools have one length.
        controller: the module that writes and reads its programs.
        settings: of its controller, with X Y Z A B C as axes.
    """

    struts: StrutMotion
    file: Path
    planned: Trajectory
    machine: Machine
    controller: Any
    settings: PmacSettings | PowerPmacSettings

    @property
    def tool_length(self) -> float:
        """Gauge length, mm."""
        return float(self.planned.tool_length()[0])

    def written(self, private: Path, out: Path, setting: Setting) -> CartesianProgram:
        """Write the parts, read them back, and certify their motion at each corner of the allowance."""
        if setting.segment_time:
            self._refuse_stops_without_events()
        guard, opening = guard_lines(self.settings, setting), self.controller.buffer_opening(self.settings)
        struts = on_segments(self.struts, setting.segment_time)
        axes = axis_motion(self.machine, struts, setting.tool_length, self.planned)
        parts = self.controller.program_parts(axes, self.settings, self._heading(setting))
        sealed = (program_files.with_own_hash(guarded(text, opening, guard)) for text in parts)
        names = outputs.write_parts(private, tuple(sealed))
        written = required(*read_axes(outputs.read_parts(private, names), self.controller, self.settings, setting))
        certificate, _ = certify_axes(written, out.name, self.file, self.machine, setting, [])
        off = float(np.abs(strut_motion(self.machine, written, setting.tool_length).length - struts.length).max())
        return CartesianProgram(tuple(out.parent / name for name in names), certificate, off)

    def _refuse_stops_without_events(self) -> None:
        """A spline over segments stops at codes and dwells alone, not where the path turns back or exact path asks."""
        stops = np.flatnonzero(self.planned.exact_stop[:-1]) + 1
        blended = np.setdiff1d(stops, [event.row for event in self.planned.events])
        if len(blended):
            found = "the motion stops at its end, without a code or a dwell, and segments do not"
            raise Refused([Diagnostic("C116", self.planned.place(blended[0] - 1), found)])

    def _heading(self, setting: Setting) -> list[str]:
        allowed = setting.allowance.words(setting.tool_length)
        digest = manifest.fingerprint_of_file(self.file)
        return [
            *(line for line in summary.heading(self.planned) if not line.startswith("axis values are strut lengths")),
            program_files.TIP_AND_AXIS,
            *_needs(self.settings, setting, allowed),
            *program_files.source_hash_lines(digest, self.machine.fingerprint),
        ]


def _needs(settings: PmacSettings | PowerPmacSettings, setting: Setting, allowed: str) -> list[str]:
    """Heading lines: what the program requires, and the values it is certified for."""
    steps = f"forward program of at most {kinematics.MOST_STEPS} steps to {kinematics.TOLERANCE[settings.KIND]:g} mm"
    if isinstance(settings, PmacSettings):
        switch = f"I{50 + settings.coordinate_system}50"
        return [
            f"runs with {switch}=1, {allowed}, never with {switch}=0: there A is a strut",
            f"kinematics in numbers of 36 bits, {steps}; no segmentation in PVT mode",
        ]
    segment = f"Coord[{settings.coordinate_system}].SegMoveTime={setting.segment_time}"
    reasons = ", ".join(f"{number} {what}" for number, what in enumerate(POWER_REASONS, start=1))
    return [
        f"runs with kinematics, {segment}, {allowed}, never with the set-up of strut lengths: there A is a strut",
        f"ends before its first move where that is otherwise, by Q66: {reasons}",
        f"kinematics in numbers of 53 bits, {steps}",
    ]
