# SPDX-License-Identifier: LGPL-2.1-or-later
"""Result files: name endings, after the stem, of the files that a posting may write.

All code takes the endings from here: the writer of a file, and the check that no result replaces another file.
"""

from __future__ import annotations

PROGRAM = ".pmc"
TRAJECTORY = ".pkmt"
REPORT = "-report.json"
PAGE = "-report.html"
PICTURE = "-report.png"
MANIFEST = "-manifest.json"
SETUPS = {"turbo_pmac": "-setup.pmc", "power_pmac": "-setup.cfg"}
"""Set-up files by ``controller.kind`` of the machine file."""
SIDE_OUTPUTS = {
    "csv": ".csv",
    "halstreamer": "-halstreamer.txt",
    "linuxcnc": "-linuxcnc.ngc",
    "picture": PICTURE,
    "cartesian": "-tip.pmc",
}
"""Optional files by the names of ``--also``: two tables of the strut motion, G-code for LinuxCNC's hexapod, the report
as a picture, and the program in X Y Z A B C for kinematics in the controller."""
