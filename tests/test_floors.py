# SPDX-License-Identifier: LGPL-2.1-or-later
"""The house rule: a room imports from lower floors alone, and each optional package has one door."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "pkm_post"

BY_FLOOR = (
    "model geometry files grammar argument_types result_names document_file pmac_simulator workers",
    "gcode cldata placement compensation kinematics feed trajectory_file controllers machine_file mesh_file "
    "report manifest unwritten out_of_memory program_end",
    "spin surface_speed surface_path speed_limits cubics reach certificate sources pmac_link machine_check "
    "machine_calibration",
    "position planning outputs collisions",
    "pipeline verify check convert",
    "options reach_study numerical_control program_text loading",
    "post_file freecad_app",
    "cli freecad_gui",
    "__main__",
)
"""Rooms from the ground floor upwards."""
FLOORS = {room: floor for floor, rooms in enumerate(BY_FLOOR) for room in rooms.split()}

DOORS = {
    "FreeCAD": ("freecad_app/", "freecad_gui/"),
    "Part": ("freecad_app/", "freecad_gui/"),
    "Path": ("freecad_app/", "freecad_gui/"),
    "PathScripts": ("freecad_app/", "freecad_gui/"),
    "FreeCADGui": ("freecad_gui/",),
    "PySide": ("freecad_gui/",),
    "pivy": ("freecad_gui/",),
    "matplotlib": ("report/",),
    "lark": ("grammar.py", "gcode/", "cldata/"),
    "serial": ("pmac_link/links.py",),
    "paramiko": ("pmac_link/ssh_link.py",),
}

MODULES = sorted(PACKAGE.rglob("*.py"))


def imported(path):
    """Every module a file imports, also inside functions."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            if node.module == "pkm_post":
                yield from (f"pkm_post.{alias.name}" for alias in node.names)
            else:
                yield node.module


def room(path):
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def test_there_are_modules():
    assert len(MODULES) > 30


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_go_down(path):
    here = room(path)
    if here == "__init__":
        # The front door: it may call any room, from inside its functions.
        body = ast.parse(path.read_text(encoding="utf-8")).body
        assert not [node for node in body if isinstance(node, ast.Import | ast.ImportFrom)]
        return
    for name in imported(path):
        parts = name.split(".")
        if parts[0] == "pkm_post" and len(parts) > 1 and parts[1] != here and not parts[1].startswith("__"):
            assert FLOORS[parts[1]] < FLOORS[here], f"{here} (floor {FLOORS[here]}) imports {name}"
        for package, doors in DOORS.items():
            if parts[0] == package:
                inside = path.relative_to(PACKAGE).as_posix()
                assert inside.startswith(doors), f"{package} is imported by {inside}"
