# SPDX-License-Identifier: LGPL-2.1-or-later
"""tools/run_script.py makes freecadcmd run a script as python3 would, and run_tests.py counts what ran."""

import os
import re
import subprocess
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[2] / "tools"
LONGEST_S = 600
"""FreeCAD starts slowly on a busy computer."""


def freecad(script, *arguments):
    """Run the script in a FreeCAD of its own, the one that this test is run by."""
    return subprocess.run(
        [os.environ["FREECADCMD"], TOOLS / "run_script.py", "--", script, *arguments],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=LONGEST_S,
    )


@pytest.fixture
def script(tmp_path):
    def write(text, name="a script.py"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def test_script_is_main_and_gets_its_arguments(script):
    path = script("import sys, FreeCAD\nif __name__ == '__main__':\n    print(sys.argv[1:], FreeCAD.Version()[0])\n")
    reported = freecad(path, "-k", "no such.FCStd", "--out", "-c", "--help", "*")
    assert reported.returncode == 0
    assert reported.stdout.splitlines()[-1] == "['-k', 'no such.FCStd', '--out', '-c', '--help', '*'] 1"


@pytest.mark.parametrize(
    ("end", "code"),
    [("", 0), ("sys.exit()", 0), ("sys.exit(3)", 3), ("sys.exit('a reason')", 1), ("raise KeyboardInterrupt", 130)],
)
def test_exit_code_is_the_scripts_and_no_text_is_lost(script, end, code):
    reported = freecad(script(f"import sys\nprint('before the end')\n{end}\n"))
    assert reported.returncode == code
    assert reported.stdout.splitlines()[-1] == "before the end"
    assert ("a reason" in reported.stderr) == ("a reason" in end)


@pytest.mark.parametrize("fault", ["1 / 0", "assert False", "def", "import no_such_module"])
def test_exception_fails_with_a_traceback(script, fault):
    reported = freecad(script(f"{fault}\n"))
    assert reported.returncode == 1
    assert "Traceback" in reported.stderr
    assert "a script.py" in reported.stderr


def test_missing_script_fails(tmp_path):
    assert freecad(tmp_path / "missing.py").returncode == 1


def test_only_the_scripts_own_text_and_freecads_errors_are_shown(script):
    reported = freecad(
        script(
            "import FreeCAD\nprint('one')\nFreeCAD.Console.PrintMessage('progress\\n')\n"
            "FreeCAD.Console.PrintError('a fault\\n')\nprint('two')\n"
        )
    )
    assert reported.stdout.splitlines()[-2:] == ["one", "two"]
    assert "progress" not in reported.stdout + reported.stderr
    assert "a fault" in reported.stderr


@pytest.mark.parametrize(
    ("body", "code", "closing"),
    [
        ("pass", 0, "1 passed"),
        ("assert 0", 1, "1 failed"),
        ("import pytest; pytest.skip('none')", 5, "1 skipped"),
    ],
)
def test_suite_fails_where_no_test_was_executed(script, body, code, closing):
    path = script(f"def test_it():\n    {body}\n", "test_it.py")
    reported = freecad(TOOLS / "run_tests.py", f"--rootdir={path.parent}", "-p", "no:cacheprovider", path)
    assert reported.returncode == code
    assert closing in reported.stdout.splitlines()[-1]


def test_suite_without_tests_fails(script):
    path = script("", "test_none.py")
    reported = freecad(TOOLS / "run_tests.py", f"--rootdir={path.parent}", "-p", "no:cacheprovider", path)
    assert reported.returncode == 5
    assert "No test was executed" in reported.stderr


def test_one_result_counts_what_all_processes_ran_and_where_one_died(script, monkeypatch):
    monkeypatch.setenv("PKM_TEST_PROCESSES", "3")
    body = "import os, signal\ndef test_before():\n    pass\ndef test_it():\n    os.kill(os.getpid(), signal.SIGKILL)\n"
    script(body, "test_killed.py")
    script("def test_fails():\n    assert 1 == 2\n", "test_failing.py")
    folder = script("def test_passes():\n    pass\n", "test_passing.py").parent
    reported = freecad(TOOLS / "run_tests.py", f"--rootdir={folder}", "-p", "no:cacheprovider", folder)
    assert reported.returncode == 1
    assert "2 failed, 2 passed" in reported.stdout.splitlines()[-1]
    assert "The process of this test died: signal 9." in reported.stdout
    assert "assert 1 == 2" in reported.stdout
    failed = [line for line in reported.stdout.splitlines() if line.startswith("FAILED ")]
    assert sorted(re.findall(r"test_\w+\.py::test_\w+", " ".join(failed))) == [
        "test_failing.py::test_fails",
        "test_killed.py::test_it",
    ]


def test_no_process_is_forked_beside_a_thread(script, monkeypatch):
    monkeypatch.setenv("PKM_TEST_PROCESSES", "2")
    waits = "import threading\nthreading.Thread(target=threading.Event().wait, daemon=True).start()\n"
    path = script(f"{waits}def test_it():\n    pass\n", "test_threads.py")
    reported = freecad(TOOLS / "run_tests.py", f"--rootdir={path.parent}", "-p", "no:cacheprovider", path)
    assert reported.returncode == 4
    assert "starts threads when it is imported" in reported.stderr
