# SPDX-License-Identifier: LGPL-2.1-or-later
"""tools/freecad chooses the right FreeCAD, says why it refuses one, and leaves its command alone.

FreeCAD is played by a shell script, which lets Python answer the question for the version. Nothing is
downloaded: a private root is forbidden throughout.
"""

import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

TOOL = Path(__file__).parents[2] / "tools" / "freecad"
NO_FREECAD = 125
NEEDED = ("bash", "dirname", "timeout", "sed", "cat", "env", "sleep")


class Machine:
    """A machine with nothing on its PATH but what the tool needs, and the FreeCADs that a test installs."""

    def __init__(self, folder):
        self.folder = folder
        self.programs = folder / "bin"
        self.programs.mkdir()
        for name in NEEDED:
            (self.programs / name).symlink_to(shutil.which(name))

    def install(self, version, path="bin/freecadcmd"):
        """Put a FreeCAD of that version at the path; it repeats its arguments, or runs `sh` for `-c`."""
        modules = self.folder / f"modules of {version}"
        modules.mkdir()
        (modules / "FreeCAD.py").write_text(f"def Version():\n    return {[*version.split('.'), '', 'a build']}\n")
        program = self.folder / path
        program.parent.mkdir(exist_ok=True)
        program.write_text(
            "#!/bin/bash\n"
            "case $1 in\n"
            f'*/freecad_probe.py) echo A banner; PYTHONPATH="{modules}" exec {shutil.which("python3")} "$1" ;;\n'
            '-c) exec /bin/sh -c "$2" ;;\n'
            "esac\n"
            f"echo 'FreeCAD {version}'; printf '<%s>\\n' \"$@\"\n"
        )
        program.chmod(0o755)
        return program

    def environment(self, **more):
        return {
            "PATH": str(self.programs),
            "HOME": str(self.folder),
            "PKM_FREECAD_NO_ROOT": "1",
            "PKM_MODULES": "json",
        } | more

    def run(self, *arguments, **environment):
        return subprocess.run(
            [TOOL, *arguments],
            env=self.environment(**environment),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=300,
        )


@pytest.fixture
def machine(tmp_path):
    folder = tmp_path / "a machine"
    folder.mkdir()
    return Machine(folder)


def test_help_names_every_setting(machine):
    reported = machine.run("--help")
    assert reported.returncode == 0
    for setting in ("FREECADCMD", "PKM_FREECAD", "PKM_FREECAD_NO_ROOT", "PKM_MODULES"):
        assert f"\n  {setting} " in reported.stdout


def test_arguments_reach_freecad_as_they_are(machine):
    machine.install("1.0.2")
    reported = machine.run("-M", ".", "a script.py", "--pass", "--help", "*")
    assert reported.stdout.splitlines() == [
        "FreeCAD 1.0.2",
        "<-M>",
        "<.>",
        "<a script.py>",
        "<--pass>",
        "<--help>",
        "<*>",
    ]
    assert reported.stderr == ""


def test_exit_code_is_that_of_the_command(machine):
    machine.install("1.1.0")
    assert machine.run("-c", "exit 7").returncode == 7
    assert machine.run("--exec", "bash", "-c", "exit 8").returncode == 8


def test_signal_reaches_the_command(machine):
    machine.install("1.1.0")
    started = machine.folder / "started"
    waiting = f"trap 'exit 9' TERM; : >'{started}'; while :; do sleep 0.05; done"
    process = subprocess.Popen([TOOL, "-c", waiting], env=machine.environment())
    while not started.exists():
        assert process.poll() is None
        time.sleep(0.02)
    process.send_signal(signal.SIGTERM)
    assert process.wait(timeout=300) == 9


def test_exec_finds_what_is_beside_freecad(machine):
    freecad = machine.install("1.1.0", "app/FreeCADCmd")
    (freecad.parent / "freecad").symlink_to(shutil.which("env"))
    reported = machine.run("--exec", "freecad", FREECADCMD=str(freecad))
    assert f"FREECADCMD={freecad}" in reported.stdout.splitlines()
    assert machine.run("--exec", "freecadcmd", "x", FREECADCMD=str(freecad)).stdout == "FreeCAD 1.1.0\n<x>\n"


@pytest.mark.parametrize("name", ["freecadcmd", "FreeCADCmd"])
def test_provide_prints_which_one(machine, name):
    program = machine.install("1.2.3", f"bin/{name}")
    reported = machine.run("--provide")
    assert reported.returncode == 0
    assert reported.stdout.startswith("FreeCAD 1.2.3, Python 3.")
    assert reported.stdout.endswith(f": {program}\n")


def test_old_freecad_is_refused(machine):
    program = machine.install("0.21.2")
    reported = machine.run("script.py")
    assert reported.returncode == NO_FREECAD
    assert reported.stdout == ""
    assert f"{program} is FreeCAD 0.21.2, too old: 1.0 or newer is needed" in reported.stderr


def test_a_second_name_is_tried(machine):
    machine.install("0.19.1", "bin/freecadcmd")
    machine.install("1.0.0", "bin/FreeCADCmd")
    assert machine.run().stdout.splitlines()[0] == "FreeCAD 1.0.0"


def test_missing_module_is_named(machine):
    program = machine.install("1.0.0")
    reported = machine.run("script.py", PKM_MODULES="json no_such_module")
    assert reported.returncode == NO_FREECAD
    assert f"{program} is FreeCAD 1.0.0, but its Python 3." in reported.stderr
    assert "cannot import: no_such_module\n" in reported.stderr


def test_freecad_that_does_not_start_is_refused(machine):
    program = machine.install("1.0.0")
    program.write_text("#!/bin/bash\necho no library >&2\nexit 1\n")
    reported = machine.run("script.py")
    assert reported.returncode == NO_FREECAD
    assert f"{program} did not start" in reported.stderr


def test_freecadcmd_variable_wins_over_path(machine):
    machine.install("1.0.0")
    chosen = machine.install("1.1.1", "elsewhere/freecadcmd")
    assert machine.run(FREECADCMD=str(chosen)).stdout.splitlines()[0] == "FreeCAD 1.1.1"


def test_freecadcmd_variable_is_never_overruled(machine):
    machine.install("1.0.0")
    chosen = machine.install("0.20.2", "elsewhere/freecadcmd")
    reported = machine.run("script.py", FREECADCMD=str(chosen))
    assert reported.returncode == NO_FREECAD
    assert reported.stdout == ""
    assert "FREECADCMD: " in reported.stderr
    assert "too old" in reported.stderr
    missing = machine.run("script.py", FREECADCMD="/no/such/freecadcmd")
    assert missing.returncode == NO_FREECAD
    assert "FREECADCMD names no command: /no/such/freecadcmd" in missing.stderr


def test_a_freecadcmd_that_starts_the_tool_is_asked_once(machine):
    wrapper = machine.programs / "freecadcmd"
    wrapper.write_text(f'#!/bin/bash\nexec "{TOOL}" "$@"\n')
    wrapper.chmod(0o755)
    for environment in ({}, {"FREECADCMD": str(wrapper)}):
        reported = machine.run("script.py", **environment)
        assert reported.returncode == NO_FREECAD
        assert f"{wrapper} starts tools/freecad again" in reported.stderr


def test_a_freecadcmd_variable_that_names_the_tool_is_none(machine):
    machine.install("1.1.1")
    assert machine.run(FREECADCMD=str(TOOL)).stdout.splitlines()[0] == "FreeCAD 1.1.1"


def test_forbidden_root_is_said(machine):
    reported = machine.run("script.py")
    assert reported.returncode == NO_FREECAD
    assert (
        "there is no freecadcmd that fits on PATH, and PKM_FREECAD_NO_ROOT forbids the private root" in reported.stderr
    )
    assert not (machine.folder / ".cache").exists()


def test_pkm_freecad_asks_for_the_private_root_whatever_is_there(machine):
    machine.install("1.0.0")
    reported = machine.run("script.py", PKM_FREECAD="1.1")
    assert reported.returncode == NO_FREECAD
    assert "PKM_FREECAD=1.1 asks for the private root" in reported.stderr


def test_unknown_version_is_refused(machine):
    reported = machine.run("script.py", PKM_FREECAD="2.0")
    assert reported.returncode == NO_FREECAD
    assert "PKM_FREECAD is '2.0'; it can be 1.0 or 1.1" in reported.stderr


def test_locale_is_set_only_where_there_is_none(machine):
    machine.install("1.0.0")
    show = ("-c", 'echo "$LANG"')
    assert machine.run(*show).stdout == "C.UTF-8\n"
    assert machine.run(*show, LANG="de_DE.UTF-8").stdout == "de_DE.UTF-8\n"
