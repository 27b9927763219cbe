# SPDX-License-Identifier: LGPL-2.1-or-later
"""Missing packages are installed from a folder with wheels, without a network, into FreeCAD's folder for packages."""

import importlib
import subprocess
import sys
from pathlib import Path

import pytest
from wheels import NAME, wheel

from pkm_post.cli import main
from pkm_post.system import packages


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The folder of FreeCAD's packages, and an optional package that is not installed."""
    monkeypatch.setattr(packages, "_PLACE", packages._Place(tmp_path / "AdditionalPythonPackages" / "py311"))
    monkeypatch.setattr(packages, "OPTIONAL", {NAME: NAME})
    monkeypatch.setattr(packages, "PURPOSES", {NAME: "tests"})
    monkeypatch.setattr("pkm_post.cli.install._BY_NAME", {NAME: NAME})
    monkeypatch.setattr(sys, "path", list(sys.path))
    yield tmp_path / "AdditionalPythonPackages" / "py311"
    sys.modules.pop(NAME, None)


@pytest.fixture(params=["with pip, where there is one", "without pip"])
def pip(request, monkeypatch):
    if request.param == "without pip":
        monkeypatch.setattr(packages, "_has_pip", lambda: False)


def test_a_wheel_is_installed_and_can_be_imported_at_once(folder, tmp_path, pip, capsys):
    assert packages.missing() == [NAME]
    assert main(["install", "--from", str(wheel(tmp_path / "my wheels"))]) == 0
    assert f"installed: {NAME}" in capsys.readouterr().out
    assert Path(importlib.import_module(NAME).__file__) == folder / f"{NAME}.py"
    assert packages.missing() == []
    assert main(["install"]) == 0
    assert "nothing is missing" in capsys.readouterr().out


def test_a_folder_without_the_wheel_is_named(folder, tmp_path, pip, capsys):
    (tmp_path / "empty").mkdir()
    assert main(["install", NAME, "--from", str(tmp_path / "empty")]) == 1
    assert NAME in capsys.readouterr().err
    assert packages.missing() == [NAME]


def test_without_pip_the_newest_wheel_is_taken_and_nothing_leaves_the_folder(folder, tmp_path, monkeypatch):
    monkeypatch.setattr(packages, "_has_pip", lambda: False)
    wheels = wheel(wheel(wheel(tmp_path / "wheels", "1.9"), "1.10"), "1.1")
    packages.install([NAME], wheels)
    assert importlib.import_module(NAME).VERSION == "1.10"
    with pytest.raises(packages.NotInstalledError, match="no module"):
        packages.install([NAME], wheel(tmp_path / "bad", module=f"../{NAME}.py"))
    assert not (folder.parent / f"{NAME}.py").exists()


def test_no_pip_and_no_folder_is_said(folder, monkeypatch, capsys):
    monkeypatch.setattr(packages, "_has_pip", lambda: False)
    assert main(["install", NAME]) == 1
    assert "has no pip" in capsys.readouterr().err


def test_what_is_no_package_or_folder_of_ours_is_refused(folder, tmp_path, capsys):
    assert main(["install", "leftpad"]) == 2
    assert "leftpad" in capsys.readouterr().err
    assert main(["install", "--from", str(tmp_path / "nowhere")]) == 2


def test_messages_name_the_line_for_this_installation(monkeypatch):
    monkeypatch.setattr(packages, "_PLACE", packages._Place())
    monkeypatch.setattr(packages, "_belongs_to_debian", lambda: False)
    fault = packages.needs("a serial line needs", "serial")
    assert (fault.name, str(fault)) == (
        "serial",
        f"a serial line needs pyserial: type: {packages.python_words()[0]} -m pip install pyserial",
    )
    monkeypatch.setattr(packages, "_belongs_to_debian", lambda: True)
    assert packages.cure("serial") == "type: sudo apt-get install python3-serial"
    assert packages.cure("lark") == "type: sudo apt-get install python3-lark"


def test_in_freecad_the_line_has_its_folder_and_its_python(folder, tmp_path, monkeypatch):
    program = tmp_path / "bin" / "FreeCAD.exe"
    program.parent.mkdir()
    (program.parent / "python.exe").write_text("")
    monkeypatch.setattr(sys, "executable", str(program))
    monkeypatch.setattr(sys, "prefix", str(program.parent))
    monkeypatch.delenv("APPIMAGE", raising=False)
    assert packages.python_words() == (str(program.parent / "python.exe"),)
    line = f"{program.parent / 'python.exe'} -m pip install --target {folder} {NAME}"
    assert packages.cure(NAME) == f"choose Install packages in the workbench PKM Post, or type: {line}"
    monkeypatch.setenv("APPIMAGE", "/apps/FreeCAD.AppImage")
    assert packages.python_words() == ("/apps/FreeCAD.AppImage", "python")


def test_a_stream_of_pip_that_fails_is_the_reason(folder, monkeypatch):
    failed = subprocess.CompletedProcess([], 1, "", "no matching distribution\n")
    monkeypatch.setattr(packages, "_has_pip", lambda: True)
    monkeypatch.setattr(packages.subprocess, "run", lambda *words, **more: failed)
    with pytest.raises(packages.NotInstalledError, match="no matching distribution"):
        packages.install([NAME])
