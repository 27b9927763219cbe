# SPDX-License-Identifier: LGPL-2.1-or-later
"""Verify: check that an existing motion program follows its trajectory file.

Input: the text of a program, of strut lengths or of tip and axis, a trajectory file and a machine. Output: the
report, as posting would have written it. Nothing is planned: the motion is reconstructed from the lengths and speeds of
the program and compared with the trajectory, so the verdict does not depend on the planner.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from pkm_post.model import Certificate, Diagnostic, Diagnostics, Machine, Place, Refused, StrutMotion, errors, required
from pkm_post.posting.program_certificate import certified
from pkm_post.writing import controller_settings, manifest, program_files, read_texts

Texts = Sequence[tuple[str, str]]


class Verified(NamedTuple):
    """A verified program.

    Attributes:
        certificate: its certificate, which holds.
        report: as posting writes it.
        diagnostics: warnings.
    """

    certificate: Certificate
    report: dict[str, Any]
    diagnostics: Diagnostics


def verify(program: Path, trajectory: Path, machine: Machine) -> Verified:
    """Certify an existing program, and check that its files were posted together.

    Args:
        program: the motion program, or the first of its parts.
        trajectory: the trajectory file it was made from; it states the requested tolerances.
        machine: the machine it was made for.

    Raises:
        Refused: a file cannot be read or is faulty, the certificate does not hold, or files differ from their manifest
            or from the heading of the program.
    """
    return verify_texts(_read(program, machine), program, trajectory, machine)


def verify_texts(texts: Texts, program: Path, trajectory: Path, machine: Machine) -> Verified:
    """Verify the texts of all parts of a program, with their file names."""
    files = (program, *filter(os.path.isfile, [trajectory]))  # a missing one is reported where it is read
    listed = tuple(dict.fromkeys(one for file in files for one in manifest.check(file)[1]))
    changed = tuple(
        Diagnostic("C109", Place(name), "the lines give another one")
        for name, text in texts
        if program_files.own_hash_matches(text) is False
    )
    diagnostics = (*listed, *changed, *_of_another_trajectory(texts, trajectory))
    try:
        certificate, report = _certified(texts, program, trajectory, machine)
    except Refused as refused:
        raise Refused((*diagnostics, *refused.diagnostics)) from None
    if errors(diagnostics):
        raise Refused(diagnostics)
    return Verified(certificate, report, diagnostics)


def _of_another_trajectory(texts: Texts, trajectory: Path) -> Diagnostics:
    """F106 for each part of a program whose heading names another trajectory file."""
    if not os.path.isfile(trajectory):  # also for a name that is too long, which is reported where it is read
        return ()
    digest = manifest.fingerprint_of_file(trajectory)
    return tuple(
        Diagnostic("F106", Place(name), f"its heading names another trajectory file than this {trajectory.name}")
        for name, text in texts
        if program_files.source_hash_matches(text, "trajectory", digest) is False
    )


def read_motion(program: Path, machine: Machine) -> StrutMotion:
    """The motion of a program in all its parts.

    Raises:
        Refused: the program cannot be read or is faulty.
    """
    return _played(_read(program, machine), machine)


def _read(program: Path, machine: Machine) -> Texts:
    """The texts of all parts of a program, by file name."""
    controller = required(*controller_settings(machine))
    return required(*read_texts(program, controller[0]))


def _certified(texts: Texts, program: Path, trajectory: Path, machine: Machine) -> tuple[Certificate, dict[str, Any]]:
    """Certify a program; return the certificate, which holds, and the report."""
    digests = [program_files.program_hash(text) for _, text in texts]
    if program_files.is_of_tip_and_axis(texts[0][1]):
        from pkm_post.posting.cartesian_check import certified_axes  # only this needs it

        return certified_axes(texts, program.name, trajectory, machine, digests)
    return certified(_played(texts, machine), program.name, trajectory, machine, digests)


def _played(texts: Texts, machine: Machine) -> StrutMotion:
    """The motion of all parts of a program."""
    controller, settings = required(*controller_settings(machine))
    return required(*controller.read_parts(texts, settings))
