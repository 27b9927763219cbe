# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cartesian form: a certified program of strut lengths as a program of tip and axis, for kinematics in a Turbo PMAC.

In PVT mode the controller runs its inverse program once for each point, with the rates of the axes, and gives each
motor a cubic between two points [Turbo PMAC User Manual, p. 265 and 266]: the same cubics as in a program of strut
lengths. So the new program has the same points and times, X Y Z in mm and A B C in degrees in {M}. It is read back from
its text, taken through the kinematics, and certified as what the struts then do. Doubles here, 36 bits in the
controller: the lengths differ by less than 2e-7 mm (docs/controller-kinematics.md). A guard ends it where the
kinematics are off, or with another tool or work frame than it is certified for.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import forward_along_path, linearise, platform_rotation
from pkm_post.model import Certificate, Diagnostic, Machine, Place, Refused, StrutMotion, Trajectory
from pkm_post.posting.cartesian_guard import Allowance, guard_lines, guarded, unguarded
from pkm_post.posting.verify import certified, read_motion, verify
from pkm_post.report import summary
from pkm_post.system import staged, write_fault
from pkm_post.writing import PmacSettings, controller_settings, manifest, outputs, pmac, program_files, trajectory_file

LETTERS = ("X", "Y", "Z", "A", "B", "C")


class CartesianProgram(NamedTuple):
    """A program of tip and axis that does what was posted.

    Attributes:
        files: its parts.
        certificate: it holds.
        off: largest difference of a strut from the program of strut lengths at its points, mm.
    """

    files: tuple[Path, ...]
    certificate: Certificate
    off: float


def cartesian_program(
    program: Path, trajectory: Path, machine: Machine, out: Path, allowance: Allowance | None = None
) -> CartesianProgram:
    """Write a program in X Y Z A B C that moves the struts as a posted one does.

    Args:
        program: the motion program, or the first of its parts.
        trajectory: the trajectory file it was made from.
        machine: the machine it was made for; its controller is a Turbo PMAC.
        out: the file to write; further parts stand beside it.
        allowance: what may be changed at the machine; nothing by default.

    Raises:
        Refused: a file cannot be read, the certificate of either program does not hold, the controller or the tools
            have no such program, or the folder cannot be written.
    """
    settings = _settings(machine)
    verify(program, trajectory, machine)
    source = _Source(read_motion(program, machine), trajectory, _planned(trajectory, program.name), machine, settings)
    try:
        with staged(out.parent) as folder:
            return source.written(folder / out.name, out, allowance or Allowance())
    except OSError as fault:
        raise Refused([write_fault(out, fault)]) from fault


def write_cartesian(file: Path, struts: StrutMotion, trajectory: Path, machine: Machine) -> float:
    """Write the form of a motion that was certified, beside its other results.

    Args:
        file: the file to write; further parts stand beside it.
        struts: the motion, as it was read back.
        trajectory: the trajectory file it was made from.
        machine: the machine it was made for.

    Returns:
        The largest difference of a strut at a point, mm.

    Raises:
        Refused: as ``cartesian_program``.
    """
    source = _Source(struts, trajectory, _planned(trajectory, file.name), machine, _settings(machine))
    return source.written(file, file, Allowance()).off


@dataclass(frozen=True)
class _Source:
    """A motion that was posted, and what it was posted for.

    Attributes:
        struts: the motion.
        file: its trajectory file.
        planned: what is in there; all tools have one length.
        machine: the machine.
        settings: of its controller, with the axes of the form.
    """

    struts: StrutMotion
    file: Path
    planned: Trajectory
    machine: Machine
    settings: PmacSettings

    def written(self, private: Path, out: Path, allowance: Allowance) -> CartesianProgram:
        """Write the parts, read them back, and certify what they do at each corner of the allowance."""
        tool_length = float(self.planned.tool_length()[0])
        guard, opening = guard_lines(self.settings, tool_length, allowance), pmac.buffer_opening(self.settings)
        axes = axis_motion(self.machine, self.struts, tool_length, self.planned)
        heading = self._heading(allowance.words(tool_length))
        parts = (guarded(text, opening, guard) for text in pmac.program_parts(axes, self.settings, heading))
        names = outputs.write_parts(private, tuple(map(program_files.with_own_hash, parts)))
        read = [(name, unguarded(text, opening, guard)) for name, text in outputs.read_parts(private, names)]
        written, faults = pmac.read_parts(read, self.settings)
        if written is None:
            raise Refused(faults)
        played = strut_motion(self.machine, written, tool_length)
        certificate, _ = certified(played, out.name, self.file, self.machine, [])
        for words, corner in allowance.corners(self.machine):
            self._certify_corner(written, tool_length, out.name, words, corner)
        off = float(np.abs(played.length - self.struts.length).max())
        return CartesianProgram(tuple(out.parent / name for name in names), certificate, off)

    def _certify_corner(self, written: StrutMotion, tool_length: float, name: str, words: str, corner: Machine) -> None:
        try:
            certified(strut_motion(corner, written, tool_length), name, self.file, corner, [])
        except Refused as refused:
            raise Refused((Diagnostic("C115", Place(name), words), *refused.diagnostics)) from None

    def _heading(self, allowed: str) -> list[str]:
        enabled = f"I{50 + self.settings.coordinate_system}50"
        digest = manifest.fingerprint_of_file(self.file)
        return [
            *(line for line in summary.heading(self.planned) if not line.startswith("axis values are strut lengths")),
            "X Y Z are the tip in mm, A B C the platform in degrees, in the machine frame; do not edit",
            f"runs with {enabled}=1, {allowed}, never with {enabled}=0: there A is a strut",
            *program_files.source_hash_lines(digest, self.machine.fingerprint),
        ]


def _settings(machine: Machine) -> PmacSettings:
    """Settings of the controller with the axes of the form.

    A Power PMAC divides PVT moves into segments where segmentation is on, and then plays other cubics.
    """
    found, faults = controller_settings(machine)
    if found is None:
        raise Refused(faults)
    settings = found[1]
    if not isinstance(settings, PmacSettings):
        kind = machine.controller["kind"]
        raise Refused([Diagnostic("M104", Place(machine.name), f"controller.kind: expected turbo_pmac, got {kind!r}")])
    try:
        return replace(settings, letters=LETTERS)
    except ValueError as fault:  # a code moves X, Y or Z
        raise Refused([Diagnostic("M104", Place(machine.name), f"controller.{fault}")]) from fault


def _planned(file: Path, name: str) -> Trajectory:
    """The trajectory of a program, whose tools have one length."""
    planned, faults = trajectory_file.read(file)
    if planned is None:
        raise Refused(faults)
    lengths = np.unique(planned.tool_length())
    if len(lengths) > 1:
        found = ", ".join(f"{length:g} mm" for length in lengths)
        raise Refused([Diagnostic("C111", Place(name), f"gauge lengths {found}")])
    return planned


def axis_motion(machine: Machine, struts: StrutMotion, tool_length: float, planned: Trajectory) -> StrutMotion:
    """Axis positions and rates at the knots of a strut motion, in its columns: mm and degrees, and per second."""
    reach = np.full(len(struts), tool_length)
    start = platform_rotation(planned.start_axis[None], np.array([planned.start_spin]))[0]
    found = forward_along_path(machine, struts.length, reach, planned.start_tip, start)
    if not found.converged.all():
        raise ValueError("struts: expected lengths that verify has followed")
    angles = _angles_of(found.rotation)
    jacobian, _ = linearise(machine, found.tip, found.rotation, reach)
    twist = np.linalg.solve(jacobian, struts.speed[..., None])
    turning = np.linalg.solve(_turning_axes(angles), twist[:, 3:])[..., 0]
    length = np.column_stack([found.tip, np.degrees(angles)])
    return replace(struts, length=length, speed=np.column_stack([twist[:, :3, 0], np.degrees(turning)]))


def strut_motion(machine: Machine, axes: StrutMotion, tool_length: float) -> StrutMotion:
    """What the controller makes of axis positions and rates: strut lengths and speeds at the same knots."""
    tip, angles = axes.length[:, :3], np.radians(axes.length[:, 3:])
    jacobian, length = linearise(machine, tip, _rotation_of(angles), np.full(len(axes), tool_length))
    turning = _turning_axes(angles) @ np.radians(axes.speed[:, 3:, None])
    twist = np.concatenate([axes.speed[:, :3, None], turning], axis=1)
    return replace(axes, length=length, speed=(jacobian @ twist)[..., 0])


def _angles_of(rotation: Array) -> Array:
    """A, B and C of Rz(C) Ry(B) Rx(A), (N, 3) in rad, without jumps."""
    pitch = np.arcsin(np.clip(-rotation[:, 2, 0], -1.0, 1.0))
    roll = np.arctan2(rotation[:, 2, 1], rotation[:, 2, 2])
    yaw = np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0])
    return np.asarray(np.unwrap(np.column_stack([roll, pitch, yaw]), axis=0))


def _rotation_of(angles: Array) -> Array:
    (a, b, c), (p, q, r) = np.cos(angles.T), np.sin(angles.T)
    rows = [
        [b * c, c * q * p - r * a, c * q * a + r * p],
        [b * r, r * q * p + c * a, r * q * a - c * p],
        [-q, b * p, b * a],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def _turning_axes(angles: Array) -> Array:
    """(N, 3, 3) whose columns are the axes that A, B and C turn about."""
    cosine, sine = np.cos(angles.T), np.sin(angles.T)
    zero, one = np.zeros(len(angles)), np.ones(len(angles))
    rows = [[cosine[1] * cosine[2], -sine[2], zero], [cosine[1] * sine[2], cosine[2], zero], [-sine[1], zero, one]]
    return np.moveaxis(np.array(rows), 2, 0)
