# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run a Python script inside FreeCAD as python3 would run it.

    freecadcmd run_script.py -- SCRIPT ARGS...

By itself freecadcmd imports a script, so its ``__main__`` part never runs; ends with exit code 0 when it raises; loses
text that is still buffered when it exits; and mixes its progress marks into what the script prints. It takes options
behind ``--pass`` for its own, and arguments behind ``--`` for files to open after the script: this one ends before.
"""

import atexit
import os
import runpy
import sys
import traceback


def keep_stdout_for_the_script():
    """Silence FreeCAD from here on, except for its warnings and errors, which go to stderr."""
    sys.stdout.flush()
    sys.stdout = os.fdopen(os.dup(1), "w", buffering=1, encoding="utf-8")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def run(script, arguments):
    """Run the script as ``__main__`` and return its exit code."""
    sys.argv = [script, *arguments]
    sys.path.insert(0, os.path.dirname(os.path.abspath(script)))
    try:
        runpy.run_path(script, run_name="__main__")
    except SystemExit as leaving:
        if leaving.code is None or isinstance(leaving.code, int):
            return leaving.code or 0
        print(leaving.code, file=sys.stderr)
        return 1
    except BaseException as error:
        traceback.print_exc()
        return 130 if isinstance(error, KeyboardInterrupt) else 1
    return 0


keep_stdout_for_the_script()
command = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
if command:
    exit_code = run(command[0], command[1:])
else:
    print("usage: freecadcmd run_script.py -- SCRIPT ARGS...", file=sys.stderr)
    exit_code = 2
atexit._run_exitfuncs()
sys.stdout.flush()
sys.stderr.flush()
os._exit(exit_code & 0xFF)  # not by way of FreeCAD, which may crash on its way out
