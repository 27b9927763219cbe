# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is optional may be missing: nothing else fails, and what needs it says what to install."""

import os
import subprocess
from pathlib import Path

from interpreter import PYTHON

ADDON = Path(__file__).parents[1]
WITHOUT = "import sys; sys.modules['lark'] = sys.modules['serial'] = sys.modules['paramiko'] = None; "


def python(code, *arguments):
    return subprocess.run(
        [PYTHON, "-c", WITHOUT + code, *map(str, arguments)],
        env=os.environ | {"PYTHONPATH": str(ADDON)},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def test_a_job_is_posted_without_lark_pyserial_and_paramiko():
    reported = python("import pkm_post.posting, pkm_post.options, pkm_post.reading.gcode; print('imported')")
    assert reported.stdout == "imported\n", reported.stderr


def test_a_part_program_needs_lark_and_says_so(tmp_path):
    part = tmp_path / "part.ngc"
    part.write_text("G0 X[1]\n")
    reported = python("from pkm_post.cli import main; sys.exit(main(sys.argv[1:]))", "check", part)
    assert reported.returncode == 1
    assert "Traceback" not in reported.stderr
    assert "lark" in reported.stderr and "install" in reported.stderr
