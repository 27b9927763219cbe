# SPDX-License-Identifier: LGPL-2.1-or-later
"""The main job of PKM Post from end to end: the paper's part as a FreeCAD job in, a certified PMAC program out.

Builds the tapered column with one quadrant of five-axis finishing and its three symmetric copies, saves it, opens it
again, and posts it through CAM's own post-processor interface. Run by ``make demo``.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path as FilePath

import FreeCAD
from build import build
from Path.Post.Command import CommandPathPost
from Path.Post.Processor import PostProcessorFactory

import pkm_post as pkm

MACHINE = "example_6tps"
PICTURE_SECONDS = 120


def main() -> int:
    """Build, post, draw; say what was done and how long it took."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=FilePath, default=FilePath("out"), help="folder for the results")
    out = parser.parse_args().out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    print(f"PKM Post {pkm.__version__} in FreeCAD {'.'.join(FreeCAD.Version()[:3])}")

    begin = time.perf_counter()
    (out / "tapered_column.FCStd").unlink(missing_ok=True)  # or FreeCAD keeps it as a backup
    document, _ = build(out=out)
    saved = FilePath(document.FileName)
    FreeCAD.closeDocument(document.Name)
    print(f"{'part and CAM job':<22}{time.perf_counter() - begin:7.2f} s   {saved.name}")

    try:
        post(saved, out / "tapered_column.pmc")
    except pkm.Refused as refused:
        print(refused, file=sys.stderr)
        return 1
    pictures(saved, out / "path.png", out / "machine.png")
    print(f"in {out}:")
    for path in sorted(out.iterdir()):
        print(f"  {path.name:<34}{path.stat().st_size / 1024:10.1f} KiB")
    return 0


def post(saved: FilePath, program: FilePath) -> None:
    """Post the saved document as CAM's Post Process command does."""
    document = FreeCAD.openDocument(str(saved))
    document.recompute()
    job = pkm.job(document)
    job.PostProcessorOutputFile = str(program)
    job.PostProcessorArgs = f"--machine {MACHINE} --also picture"
    for _, text in PostProcessorFactory.get_post_processor(job, "hexapod_pmac").export():
        CommandPathPost()._write_file(str(program), text, "Overwrite existing file")
    FreeCAD.closeDocument(document.Name)


def pictures(saved: FilePath, path: FilePath, machine: FilePath) -> None:
    """Path and machine in FreeCAD's 3D view; without a display or Xvfb there are none, and that is said."""
    window = shutil.which("freecad") or shutil.which("FreeCAD")
    display = [] if os.environ.get("DISPLAY") else [shutil.which("xvfb-run"), "-a", "-s", "-screen 0 1600x1200x24"]
    if not window or None in display:
        print("no pictures of path and machine: neither a display nor xvfb-run is there")
        return
    begin = time.perf_counter()
    here = FilePath(__file__).resolve()
    command = [*display, window, "-M", str(here.parents[2]), str(here.with_name("picture.py"))]
    for target in (path, machine):
        target.unlink(missing_ok=True)
    files = {"PKM_DOCUMENT": str(saved), "PKM_PATH_PICTURE": str(path), "PKM_PICTURE": str(machine)}
    subject = files | {"PKM_MACHINE": MACHINE}
    drawn = subprocess.run(
        command, env=os.environ | subject, capture_output=True, text=True, timeout=PICTURE_SECONDS, check=False
    )
    if drawn.returncode or not (path.exists() and machine.exists()):
        raise RuntimeError(f"the pictures were not made, exit code {drawn.returncode}:\n{drawn.stdout}{drawn.stderr}")
    print(f"{'pictures':<22}{time.perf_counter() - begin:7.2f} s   {path.name}, {machine.name}")


if __name__ == "__main__":
    sys.exit(main())
