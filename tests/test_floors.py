# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rules of the house: floors go down, a room is entered by its door, and each optional package has one door."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "pkm_post"

BY_FLOOR = (
    "model",
    "geometry",
    "system report",
    "reading toolpath",
    "writing machine",
    "options planning",
    "certificate",
    "posting",
    "control",
    "freecad_app",
    "cli freecad_gui",
    "__main__",
)
"""Rooms from the ground floor upwards. A room imports from lower floors only, not from its neighbours."""
FLOORS = {room: floor for floor, rooms in enumerate(BY_FLOOR) for room in rooms.split()}

WITHOUT_A_DOOR = ("freecad_app", "freecad_gui")
"""FreeCAD enters these by the paths of modules that documents and its start-up name."""

DOORS = {
    "FreeCAD": ("freecad_app/", "freecad_gui/"),
    "Part": ("freecad_app/", "freecad_gui/"),
    "Path": ("freecad_app/", "freecad_gui/"),
    "PathScripts": ("freecad_app/", "freecad_gui/"),
    "FreeCADGui": ("freecad_gui/",),
    "PySide": ("freecad_gui/",),
    "pivy": ("freecad_gui/",),
    "matplotlib": ("report/",),
    "lark": ("reading/",),
    "serial": ("control/link/links.py",),
    "paramiko": ("control/link/ssh_link.py",),
}
"""Where an optional package may be imported."""

MODULES = sorted(PACKAGE.rglob("*.py"))


def room(path):
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imports(path):
    """Modules and names that a file imports, as it writes them; also inside functions and for types only."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((alias.name, "") for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            yield from ((node.module, alias.name) for alias in node.names)


def imports_of_rooms(path):
    """Room, module and name of each import of another room."""
    for module, name in imports(path):
        parts = module.split(".")
        if parts[0] == "pkm_post":
            target = parts[1] if len(parts) > 1 else name
            if target in FLOORS and target != room(path):
                yield target, module, name


def test_there_are_modules():
    assert len(MODULES) > 30


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_go_down(path):
    here = room(path)
    if here == "__init__":
        # The front door of the house: it may call any room, from inside its functions.
        body = ast.parse(path.read_text(encoding="utf-8")).body
        assert not [node for node in body if isinstance(node, ast.Import | ast.ImportFrom)]
        return
    for target, module, name in imports_of_rooms(path):
        assert FLOORS[target] < FLOORS[here], f"{here} (floor {FLOORS[here]}) imports {module}.{name}"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_rooms_are_entered_by_their_doors(path):
    for target, module, name in imports_of_rooms(path):
        if target not in WITHOUT_A_DOOR:
            assert module == f"pkm_post.{target}", f"{module} is behind the door of {target}"
            assert name in exported(target), f"{name} is not in __all__ of {target}"


def exported(target):
    """The names of a door."""
    body = ast.parse((PACKAGE / target / "__init__.py").read_text(encoding="utf-8")).body
    (names,) = (ast.literal_eval(node.value) for node in body if _is_all(node))
    return names


def _is_all(node):
    return isinstance(node, ast.Assign) and [getattr(target, "id", None) for target in node.targets] == ["__all__"]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_optional_packages_have_one_door(path):
    inside = path.relative_to(PACKAGE).as_posix()
    for module, _ in imports(path):
        doors = DOORS.get(module.split(".")[0])
        assert not doors or inside.startswith(doors), f"{module} is imported by {inside}"
