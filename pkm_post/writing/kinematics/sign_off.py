# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sign-off sheet: checks for the operator and the controls engineer before using kinematics in the controller.

Input: the machine, the target, the files with their SHA-256, and positions with the strut lengths that PKM Post
computes for them. Output: Markdown with a box for each check.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array, Machine
from pkm_post.writing.kinematics.variables import FIRST_NUMBER, LAST_NUMBER


@dataclass(frozen=True)
class CheckPoses:
    """Positions to compare at the machine.

    Attributes:
        axes: (N, 6) X Y Z in mm and A B C in degrees, work frame {M}.
        lengths: (N, 6) counted strut lengths, mm.
        tool_length: gauge length of the tool, mm.
    """

    axes: Array
    lengths: Array
    tool_length: float


COMMON_CHECKS = (
    "The machine file is that of this machine as it stands: joints measured, not drawn.",
    "Every strut extends when its length grows, and its soft limits and limit switches are where the file has them.",
    "The drives are homed as `controller.zero_length` of the machine file assumes.",
    "First moves are made in free air, at low override, with a hand on the emergency stop.",
    "At the positions below the display of motors agrees with the table, and a tool held against a known point agrees"
    " with X Y Z, upright and tilted.",
)
PMAC_CHECKS = (
    "The file is read line by line by the controls engineer, then loaded; the controller reports no error.",
    "Motors 1 to 6 belong to no other coordinate system; limits, speeds and accelerations are read back as written.",
    "Programs of `pkm-post post` are strut lengths: they need the set-up file of a posting again, which replaces these"
    " axis definitions. The two are never mixed.",
    "After a change of tool length or work frame: `PMATCH`, or the first move starts from the old position.",
    "The forward program finds the same axis positions from the table's counts, with outcome 0.",
    "Joints, cones, collisions and singular poses are not checked by the controller: it knows the strokes alone.",
)
_PER_OPERATION = 0.0031
"""ms per operation."""
_SEGMENTS = (
    "How far the tool is off between segments: the fine interpolation is a cubic B-spline of the segment points, which"
    " cuts inside by about v^2 T^2 / (6 r) on a radius r."
)
OPEN_QUESTIONS: Mapping[str, tuple[str, ...]] = {
    "turbo-pmac": (
        "How long the inverse program takes, which runs in every segment of {segment_time} ms. It has {operations}"
        " operations; the Software Reference (p. 489) has 3.1 us for some on an 80 MHz CPU, so expect {time:.1f} ms and"
        " more. The run-time error bit says whether the controller keeps up.",
        "What a division by zero and a root of a negative number give. The programs divide by strut lengths only, and"
        " stop where a pivot is below the least one.",
        "Whether the run-time error that the forward program sets is shown as such at `R` and `PMATCH`, where no"
        " program runs yet.",
        "M145 to M645 and the M-variable of the run-time error are the manual's suggested definitions: nothing else"
        " may use these numbers.",
        _SEGMENTS,
        "I15 holds for the whole controller: other programs that count on radians do not go with it.",
        "How rotations alone are timed: F belongs to X Y Z (FRAX), turns of A B C alone take the default move time.",
    ),
    "power-pmac": (
        "How long the inverse program takes, which runs in every segment of {segment_time} ms. It has {operations}"
        " operations. Coord[].ErrorStatus says whether the controller keeps up.",
        "The bit of Ldata.Status that tells a motion program from a query: text and example of the User's Manual"
        " differ ($40 and 40). $40 is written.",
        "Two queries of axis positions at once, from two connections, share the variables of the forward program.",
        "That Motor[n].CoordSf[0] to [2] and [6] to [8] are 0 once this file is loaded: programs of tip and axis take"
        " another value for kinematics that are off, and end before their first move with Q66 = 1.",
        "That PVT moves of tip and axis are divided from the last rest on, in segments of exactly SegMoveTime, and that"
        " their spline is a uniform cubic B-spline: programs with `cartesian --segment-time` are certified as that.",
        "Velocity queries call the program a second time by `callsub 100`, as the User's Manual recommends.",
        "Whether Coord[].HomeComplete covers all six motors in the firmware at hand.",
        _SEGMENTS,
        "How rotations alone are timed: F belongs to X Y Z (frax), turns of A B C go by Coord[].AltFeedRate.",
    ),
}


def sign_off_sheet(
    machine: Machine,
    target: str,
    files: Mapping[str, str],
    poses: CheckPoses,
    counts: Sequence[Sequence[int]],
    segment_time: int,
    operations: int,
) -> str:
    """The sheet for a PMAC.

    Args:
        machine: the exported machine.
        target: ``"turbo-pmac"`` or ``"power-pmac"``.
        files: SHA-256 of the files, by name.
        poses: positions to compare.
        counts: of the six motors at each of them.
        segment_time: ms.
        operations: of one run of the inverse program.
    """
    figures = {"segment_time": segment_time, "operations": operations, "time": operations * _PER_OPERATION}
    questions = [question.format(**figures) for question in OPEN_QUESTIONS[target]]
    return "\n".join([
        *heading(machine, target, files),
        *_boxes("Before the first move", (*PMAC_CHECKS, *COMMON_CHECKS)),
        *_boxes("What the manuals leave open, to be found out at this controller", questions),
        *_variables(machine),
        *table(poses, "counts", [[str(count) for count in row] for row in counts]),
        *signatures(),
    ])  # fmt: skip


LINUXCNC_CHECKS = (
    "The drives of `-simulated-drives.hal` are replaced by those of the machine, with their scales, enables, limits and"
    " emergency stop, and homing is set up: as written, a joint counts as homed where it stands.",
    "Joint i - 1 is strut i, and its position is counted length plus `struts.length_offset`.",
    "Tool lengths in the tool table are `spindle_nose` plus gauge length, and every tool of a program is in it.",
    "Tools change with the platform upright; G43 lifts base and platform joints alike (genhexkins).",
    "All work offsets are zero for `-linuxcnc.ngc` of a posting, which is in {M}.",
    "LinuxCNC plans within the speeds and accelerations of X Y Z A B C. Those of the joints are for jogging alone: a"
    " program that asks a strut for more is not slowed down.",
    "Angular accelerations are assumed: those at which the outermost platform joint has the acceleration of a strut.",
    "Joints, cones, collisions and singular poses are not checked by LinuxCNC: it knows the strokes alone.",
    "`-stream.hal`, where it is used: a first row that is not where the struts are is refused, and no strut moves;"
    " `streamer.0.underruns` stays 0 in the whole program.",
)


def linuxcnc_sheet(machine: Machine, files: Mapping[str, str], poses: CheckPoses) -> str:
    """The sheet for LinuxCNC; positions with G43, and joints in mm."""
    joints = poses.lengths + machine.length_offset
    return "\n".join([
        *heading(machine, "linuxcnc", files),
        *_boxes("Before the first move", (*LINUXCNC_CHECKS, *COMMON_CHECKS)),
        *table(poses, "joint positions in mm", [[f"{value:.6f}" for value in row] for row in joints.tolist()]),
        *signatures(),
    ])  # fmt: skip


_TRIED = {
    "linuxcnc": "The authors ran such configurations in LinuxCNC with simulated drives, and none on a machine.",
}
_UNTRIED = (
    "Nothing of this was tried on a controller by the authors. The programs were compared with PKM Post's own"
    " kinematics by an interpreter that follows the manuals; what a manual leaves open is listed below."
)


def heading(machine: Machine, target: str, files: Mapping[str, str]) -> list[str]:
    """Title, machine and files."""
    return [
        f"# Sign-off: kinematics of {machine.name} on {target}",
        "",
        _TRIED.get(target, _UNTRIED),
        "",
        f"Machine file SHA-256: `{machine.fingerprint}`",
        "",
        "| file | SHA-256 |",
        "|---|---|",
        *(f"| {name} | `{digest}` |" for name, digest in files.items()),
        "",
    ]


def _boxes(title: str, texts: Sequence[str]) -> list[str]:
    return [f"## {title}", "", *(f"- [ ] {text}" for text in texts), ""]


def _variables(machine: Machine) -> list[str]:
    lines = [
        "## Variables",
        "",
        f"The programs own Q0 and Q{FIRST_NUMBER} to Q{LAST_NUMBER} of their coordinate system. The operator sets Q50,"
        " gauge length of the tool, Q51 to Q53, origin of the work frame in {M}, and Q54, its rotation about Z.",
        "",
    ]
    rows = [_work_offset(name, pose) for name, pose in machine.work_offsets.items()]
    if rows:
        lines += ["| work offset | Q51 | Q52 | Q53 | Q54 |", "|---|---|---|---|---|", *rows, ""]
    return lines


_UPRIGHT = 1e-9


def _work_offset(name: str, pose: Array) -> str:
    if abs(pose[2, 2] - 1.0) > _UPRIGHT:
        return f"| {name} | tilted: cannot be set in the controller | | | |"
    turn = np.degrees(np.arctan2(pose[1, 0], pose[0, 0]))
    x, y, z = pose[:3, 3] + 0.0
    return f"| {name} | {x:.6f} | {y:.6f} | {z:.6f} | {turn + 0.0:.6f} |"


def table(poses: CheckPoses, what: str, rows: Sequence[Sequence[str]]) -> list[str]:
    """The positions with the reading of each strut."""
    found = [
        "## Positions to compare",
        "",
        f"Tool of {poses.tool_length:g} mm, work frame {{M}}: all offsets zero. X Y Z in mm, A B C in degrees; then"
        f" {what} of struts 1 to 6.",
        "",
        "| X | Y | Z | A | B | C | 1 | 2 | 3 | 4 | 5 | 6 | seen |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for axes, row in zip(poses.axes, rows, strict=True):
        found.append("| " + " | ".join([*(f"{value + 0.0:g}" for value in axes), *row, "[ ]"]) + " |")
    if not len(poses.axes):
        found.append("\nNone: the machine reaches no position near its home pose with this tool.")
    return [*found, ""]


def signatures() -> list[str]:
    """The last lines."""
    return ["## Signed", "", "| controls engineer | operator | date |", "|---|---|---|", "| | | |", ""]
