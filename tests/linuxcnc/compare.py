# SPDX-License-Identifier: LGPL-2.1-or-later
"""Both outputs for LinuxCNC, run in LinuxCNC without a screen and compared with PKM Post: ``make linuxcnc``.

Needs Debian's package linuxcnc-uspace; where it is missing nothing is compared, and the exit code is 0. The drives are
simulated. For the example machine, and for one with joints and offsets that are no two alike and screws that turn:

* the program for genhexkins runs in the configuration of ``machine export``. In every millisecond the joints are the
  strut lengths of PKM Post at the position that LinuxCNC commands, and the tip of the joints is on the trajectory;
* the table for halstreamer goes through the gate of the exported HAL file: row by row as it stands, or, with the struts
  1 mm from its first row, not at all.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

TESTS = Path(__file__).parents[1]
sys.path[:0] = [str(TESTS), str(TESTS / "writing" / "kinematics")]

import exported_machines as made  # noqa: E402
import programs  # noqa: E402

from pkm_post.machine import ToolPoses, forward_along_path, strut_lengths  # noqa: E402
from pkm_post.options import Options  # noqa: E402
from pkm_post.posting import export_machine, post  # noqa: E402
from pkm_post.toolpath import ToolPose  # noqa: E402
from pkm_post.writing import kinematics, trajectory_file  # noqa: E402

TOOL = 120.0
PRINTED = 1e-6
"""mm: a digit of halsampler, which has six decimals."""
ROUNDING = 5e-6
"""mm: half a digit of a joint and, through the Jacobian, of six axis values."""
LAG = 2
"""Periods from the position that LinuxCNC commands to the joints that it interpolates."""
PATH_TOLERANCE = 1e-3
"""mm: P of G64 in the program, --tip-tolerance."""
ON_PATH = PATH_TOLERANCE + 1e-3
"""mm: LinuxCNC's blends keep to P by its own measure; a micrometre more is for that."""
FIRST_PERIODS = 50
"""ms after the tool length came into force."""


def main() -> int:
    if shutil.which("linuxcnc") is None:
        print("linuxcnc is not installed (Debian: linuxcnc-uspace): nothing was compared")
        return 0
    for name, machine in (("example", made.example()), ("calibrated, with screws that turn", made.screwed())):
        with tempfile.TemporaryDirectory(prefix="pkm-post-linuxcnc-") as folder:
            environment = _environment(Path(folder))
            print(f"{name}:", flush=True)
            trajectory, table, stem = _write(machine, Path(folder))
            compare_program(machine, trajectory, Path(folder), stem, environment)
            compare_table(machine, table, Path(folder), stem, environment)
    return 0


def _environment(folder: Path) -> dict[str, str]:
    """Where LinuxCNC may write; its real-time process gives up the rights of root and needs a place for its FIFO."""
    found = os.environ | {"HOME": str(folder), "RTAPI_FIFO_PATH": str(folder / "rtapi_fifo")}
    found.pop("PYTHONPATH", None)  # LinuxCNC has a Python of its own
    found["PATH"] = os.pathsep.join(["/usr/bin", "/bin", found["PATH"]])
    if os.getuid() == 0:
        folder.chmod(0o777)
        found["RTAPI_UID"] = "65534"
    return found


def _write(machine, folder: Path):
    """Post a path that tilts the tool, and export the machine; returns trajectory, tables and stem."""
    program = programs.cone(120, turns=1.0)
    post(program, machine, folder / "program.pmc", Options(also=("linuxcnc", "halstreamer")))
    (folder / "program-linuxcnc.ngc").rename(folder / "program.ngc")
    trajectory, faults = trajectory_file.read(folder / "program.pkmt")
    assert trajectory is not None, faults
    files, faults = export_machine(machine, "exported", "linuxcnc", folder, kinematics.Export(10, TOOL))
    assert files, faults
    return trajectory, sorted(folder.glob("program-halstreamer*.txt")), "exported"


def compare_program(machine, trajectory, folder: Path, stem: str, environment: dict[str, str]) -> None:
    """Run the program for genhexkins, and compare every period."""
    rows = _sampled_program(folder, stem, environment)
    joints, position, lift = rows[:, :6], rows[:, 6:12], rows[:, 12]
    there = np.flatnonzero(lift == round(machine.spindle_nose + TOOL, 6))
    assert len(there) > 1000, "the tool length was never in force"
    rows_with_tool = slice(there[0] + FIRST_PERIODS, there[-1] + 1)
    joints, position, lift = joints[rows_with_tool], position[rows_with_tool], lift[rows_with_tool]
    counted = joints - machine.length_offset
    pose = made.tool_poses(np.column_stack([position[:, :2], position[:, 2] - lift, position[:, 3:]]), tool_length=TOOL)
    struts_apart = np.abs(counted[LAG + 1 :] - _interpolated(strut_lengths(machine, *pose))[: 1 - LAG]).max()
    found = _tips(machine, counted, pose)
    off_path = _distance_to_polyline(found, np.vstack([trajectory.start_tip, trajectory.tip]))
    missed = np.linalg.norm(found - trajectory.tip[-1], axis=1).min()
    print(f"  program: {len(joints)} periods, struts at most {struts_apart * 1e3:.4f} um from ours,", flush=True)
    print(f"  tip at most {off_path.max() * 1e3:.3f} um from the path at P{PATH_TOLERANCE:g}", flush=True)
    assert struts_apart < ROUNDING
    assert off_path.max() < ON_PATH
    assert missed < PRINTED * 10, "the program did not get to the end of the path"


def _interpolated(lengths):
    """What LinuxCNC makes of joint positions, one in each period: the cubic B-spline of them [its cubic.c]."""
    return (lengths[:-2] + 4.0 * lengths[1:-1] + lengths[2:]) / 6.0


def _tips(machine, counted, pose: ToolPoses):
    start = ToolPose(pose.tip[0], np.eye(3)[2], 0.0)
    found = forward_along_path(machine, counted, np.full(len(counted), TOOL), start)
    assert found.converged.all(), "joints that fit no pose"
    return found.tip


def _distance_to_polyline(points, corners):
    """(N,) distances to the nearest of the lines between corners."""
    nearest = np.full(len(points), np.inf)
    for start, end in zip(corners[:-1], corners[1:], strict=True):
        along = end - start
        share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(points - start - share[:, None] * along, axis=1))
    return nearest


def _sampled_program(folder: Path, stem: str, environment: dict[str, str]):
    """Rows of joints, axes and tool length in each period of the program."""
    pins = [f"joint.{joint}.pos-cmd" for joint in range(6)] + [f"axis.{axis}.pos-cmd" for axis in "xyzabc"]
    sampler = ["loadrt sampler depth=30000 cfg=" + 13 * "f", "addf sampler.0 servo-thread"]
    sampler += [f"net sampled-{row} {pin} => sampler.0.pin.{row}" for row, pin in enumerate(pins)]
    sampler.append("net tool-length => sampler.0.pin.12")
    (folder / "sampler.hal").write_text("\n".join(sampler) + "\n")
    operator = folder / "at_the_screen.py"
    shutil.copy(Path(__file__).parent / "operator_of_linuxcnc.py", operator)
    operator.chmod(0o755)
    ini = folder / f"{stem}.ini"
    text = ini.read_text().replace("DISPLAY = axis", "DISPLAY = ./at_the_screen.py")
    ini.write_text(text.replace("[KINS]", "HALFILE = sampler.hal\n\n[KINS]"))
    log = folder / "linuxcnc.log"
    with log.open("w") as stream:
        subprocess.run(
            ["linuxcnc", "-r", ini.name], cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=stream,
            stderr=subprocess.STDOUT, timeout=600, check=False,
        )  # fmt: skip
    assert (folder / "finished").exists(), f"LinuxCNC did not finish:\n{log.read_text()[-4000:]}"
    return _rows(folder / "sampled.txt")


def _rows(file: Path):
    """Rows of halsampler -t without their numbers, which have to follow each other."""
    found = np.array([line.split() for line in file.read_text().splitlines() if "overrun" not in line], dtype=float)
    assert (np.diff(found[:, 0]) == 1).all(), "the sampler lost rows"
    return found[:, 1:]


def compare_table(machine, tables: list[Path], folder: Path, stem: str, environment: dict[str, str]) -> None:
    """Stream the table through the gate, from its first row and from 1 mm beside it."""
    table = np.loadtxt(tables[0])
    streamed, accepted, refused = _streamed(folder, stem, tables[0], table[0], environment)
    assert accepted.any() and not refused.any(), "the gate refused a table that begins where the struts are"
    first = int(np.argmax(accepted))
    count = min(len(table), len(streamed) - first)
    assert count == len(table), f"{count} of {len(table)} rows were sampled"
    np.testing.assert_array_equal(streamed[first : first + count], table)
    np.testing.assert_array_equal(streamed[:first][-1], table[0])
    print(f"  table: {count} rows as they stand", flush=True)
    beside = table[0] + [0, 0, 1.0, 0, 0, 0]
    streamed, accepted, refused = _streamed(folder, stem, tables[0], beside, environment, seconds=2.0)
    assert refused.any() and not accepted.any(), "the gate took a table that begins 1 mm beside the struts"
    np.testing.assert_allclose(streamed[-1], beside, rtol=0, atol=PRINTED)
    np.testing.assert_array_equal(np.ptp(streamed[len(streamed) // 2 :], axis=0), 0.0)
    print("  table 1 mm beside the struts: refused, and no strut moved", flush=True)


def _streamed(
    folder: Path, stem: str, table: Path, feedback, environment: dict[str, str], seconds: float | None = None
):
    """Commands of the struts, and whether the gate accepted and refused, in each period."""
    lines = ["loadrt threads name1=servo-thread period1=1000000", f"source {stem}-stream.hal"]
    lines += ["loadrt sampler depth=30000 cfg=ffffffbb", "addf sampler.0 servo-thread"]
    lines += [f"net strut-{strut}-cmd => sampler.0.pin.{strut}" for strut in range(6)]
    lines += ["net stream-accepted => sampler.0.pin.6", "net stream-refused => sampler.0.pin.7"]
    (folder / "stream-session.hal").write_text("\n".join(lines) + "\n")
    sampled = folder / "streamed.txt"

    def hal(*words: str) -> str:
        # to a file: the real-time process that the first command starts keeps its output open
        with (folder / "halcmd.txt").open("w+") as output:
            done = subprocess.run(
                ["halcmd", *words], cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=output,
                stderr=subprocess.STDOUT, timeout=60, check=False,
            )  # fmt: skip
            output.seek(0)
            said = output.read()
        assert done.returncode == 0, f"halcmd {' '.join(words)}: {said}"
        return said.strip().rsplit("\n", 1)[-1]

    try:
        hal("-f", "stream-session.hal")
        for strut, length in enumerate(feedback):
            hal("sets", f"strut-{strut}-fb", f"{length:.9f}")
        hal("start")
        with sampled.open("w") as rows, table.open() as text:
            sampler = subprocess.Popen(["halsampler", "-t"], env=environment, stdout=rows)
            source = subprocess.Popen(["halstreamer"], env=environment, stdin=text)
            try:
                _wait(lambda: int(hal("getp", "streamer.0.curr-depth")) > 1000)
                hal("sets", "drives-on", "TRUE")
                time.sleep(0.1)  # the commands stand still, from the feedback
                hal("sets", "stream-start", "TRUE")
                if seconds is None:
                    _wait(lambda: hal("getp", "streamer.0.empty") == "TRUE")
                time.sleep(seconds or 0.5)
            finally:
                for process in (sampler, source):
                    process.terminate()
                    process.wait()
    finally:
        subprocess.run(
            ["halrun", "-U"],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=60,
            check=False,
        )
    rows = _rows(sampled)
    return rows[:, :6], rows[:, 6] > 0, rows[:, 7] > 0


def _wait(holds, seconds: float = 200.0) -> None:
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.1)


if __name__ == "__main__":
    sys.exit(main())
