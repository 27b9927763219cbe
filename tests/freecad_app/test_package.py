# SPDX-License-Identifier: LGPL-2.1-or-later
"""package.xml says what the add-on manager of FreeCAD needs, and names files that are there."""

import ast
import json
from pathlib import Path as FilePath

import FreeCAD as App
import pytest

import pkm_post
from pkm_post.freecad_app.arguments import POST_PROCESSORS

ROOT = FilePath(__file__).resolve().parents[2]
PACKAGE = App.Metadata(str(ROOT / "package.xml"))


def test_version_is_that_of_the_package():
    assert PACKAGE.Version == pkm_post.__version__


def test_freecad_may_run_it():
    assert PACKAGE.supportsCurrentFreeCAD()
    (workbench,) = PACKAGE.Content["workbench"]
    assert (workbench.Classname, workbench.Subdirectory) == ("PkmPostWorkbench", "./")


def test_class_of_the_workbench_exists():
    source = (ROOT / "pkm_post" / "freecad_gui" / "workbench.py").read_text(encoding="utf-8")
    classes = [node.name for node in ast.parse(source).body if isinstance(node, ast.ClassDef)]
    assert PACKAGE.Content["workbench"][0].Classname in classes


def test_post_processors_are_where_newer_versions_of_freecad_look():
    named = [ROOT / each.Subdirectory / f"{each.Name}_post.py" for each in PACKAGE.Content["Postprocessor"]]
    assert sorted(named) == sorted((ROOT / "postprocessors").rglob("*.py"))
    assert [each.Name for each in PACKAGE.Content["Postprocessor"]] == [*POST_PROCESSORS, "hexapod_machine"]


def test_machines_are_where_newer_versions_of_freecad_look():
    (machine,) = PACKAGE.Content["machine"]
    (file,) = (ROOT / machine.Subdirectory).glob("*.fcm")
    assert json.loads(file.read_text(encoding="utf-8"))["machine"]["name"] == machine.Name


def test_dependencies():
    depends = {depend["package"]: depend["optional"] for depend in PACKAGE.Depend}
    assert depends == {
        "cam": False,
        "numpy": False,
        "lark": True,
        "pyserial": True,
        "matplotlib": True,
        "paramiko": True,
    }


def test_licence_and_icons_are_there():
    assert PACKAGE.License == [{"name": "LGPL-2.1-or-later", "file": "LICENSE"}]
    for path in ("LICENSE", PACKAGE.Icon, PACKAGE.Content["workbench"][0].Icon):
        assert (ROOT / path).is_file()


@pytest.mark.parametrize("name", ["pkm_post.svg", "mirror.svg", "rotate.svg", "program.svg"])
def test_icon_is_svg(name):
    assert "<svg" in (ROOT / "resources" / "icons" / name).read_text(encoding="utf-8")
