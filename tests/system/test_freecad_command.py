# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCADCmd is found where FreeCAD's bundles install it, on each system, and where FREECADCMD says."""

import pytest

from pkm_post.system import freecad_command


@pytest.fixture
def made(tmp_path):
    def make(name):
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("#!/bin/sh\n")
        file.chmod(0o755)
        return str(file)

    return make


@pytest.mark.parametrize(
    ("system", "variable", "older", "newer", "more"),
    [
        ("win32", "ProgramFiles", "FreeCAD 1.9/bin/freecadcmd.exe", "FreeCAD 1.10/bin/freecadcmd.exe", ()),
        (
            "win32",
            "LOCALAPPDATA",
            "Programs/FreeCAD 1.0/bin/freecadcmd.exe",
            "Programs/FreeCAD 1.1/bin/freecadcmd.exe",
            (),
        ),
        (
            "darwin",
            "HOME",
            "Applications/FreeCAD.app/Contents/Resources/bin/freecadcmd",
            "Applications/FreeCAD 1.1.app/Contents/Resources/bin/freecadcmd",
            (),
        ),
        (
            "linux",
            "HOME",
            "Applications/FreeCAD_1.0.2-conda-Linux-x86_64-py311.AppImage",
            "Applications/FreeCAD_1.1.0-Linux-x86_64-py311.AppImage",
            ("freecadcmd",),
        ),
    ],
)
def test_the_newest_of_the_installed_ones(tmp_path, made, system, variable, older, newer, more):
    made(older)
    found = freecad_command({"PATH": "", variable: str(tmp_path)}, system)
    assert found.words == (str(tmp_path / older), *more)
    assert freecad_command({"PATH": "", variable: str(tmp_path)}, "sunos").words == ()
    newest = made(newer)
    assert freecad_command({"PATH": "", variable: str(tmp_path)}, system).words == (newest, *more)


@pytest.mark.parametrize("name", ["freecadcmd", "FreeCADCmd", "freecad.cmd"])
def test_the_path_goes_before_other_places(tmp_path, made, name):
    made("Applications/FreeCAD.AppImage")
    on_path = made(f"bin/{name}")
    assert freecad_command({"PATH": str(tmp_path / "bin"), "HOME": str(tmp_path)}, "linux").words == (on_path,)


def test_the_variable_goes_before_the_path_and_may_have_arguments(tmp_path, made):
    made("bin/freecadcmd")
    path = {"PATH": str(tmp_path / "bin")}
    appimage = made("My Apps/FreeCAD.AppImage")
    other = made("bin/flatpak")

    def chosen(text, system="linux"):
        return freecad_command(path | {"FREECADCMD": text}, system).words

    assert chosen(appimage) == (appimage, "freecadcmd")  # a path with a blank
    assert chosen(f"'{appimage}'") == (appimage, "freecadcmd")
    assert chosen(f"'{appimage}' freecadcmd --safe-mode") == (appimage, "freecadcmd", "--safe-mode")
    assert chosen("flatpak run --command=FreeCADCmd org.freecad.FreeCAD") == (
        other,
        "run",
        "--command=FreeCADCmd",
        "org.freecad.FreeCAD",
    )
    assert chosen(f'"{appimage}" --safe-mode', "win32") == (appimage, "--safe-mode")


def test_backslashes_of_windows_stay(monkeypatch):
    monkeypatch.setattr("os.path.exists", lambda path: path == r"C:\Program Files\FreeCAD 1.1\bin\freecadcmd.exe")
    words = freecad_command(
        {"PATH": "", "FREECADCMD": r'"C:\Program Files\FreeCAD 1.1\bin\freecadcmd.exe" --safe-mode'}, "win32"
    ).words
    assert words == (r"C:\Program Files\FreeCAD 1.1\bin\freecadcmd.exe", "--safe-mode")


@pytest.mark.parametrize(
    ("text", "missing"),
    [
        ("/no/such/freecadcmd --safe-mode", "FREECADCMD names /no/such/freecadcmd, and there is no such file"),
        ("'freecadcmd", 'FREECADCMD is "\'freecadcmd": No closing quotation'),
    ],
)
def test_a_variable_that_names_nothing_is_not_replaced_by_another(tmp_path, made, text, missing):
    made("freecadcmd")
    found = freecad_command({"PATH": str(tmp_path), "FREECADCMD": text}, "linux")
    assert (found.words, found.missing) == ((), missing)


def test_the_searched_places_are_named(tmp_path):
    missing = freecad_command({"PATH": "", "ProgramFiles": str(tmp_path)}, "win32").missing
    assert missing == f"there is none on the path, nor in {tmp_path}/FreeCAD*/bin/freecadcmd.exe"
