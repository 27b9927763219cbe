# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rules of the house: floors go down, a room is entered by its door, and each optional package has one door."""

import ast
import importlib
import re
import sys
from functools import cache
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "pkm_post"

BY_FLOOR = (
    "model",
    "geometry",
    "system report",
    "reading toolpath",
    "writing machine removal",
    "options planning",
    "certificate",
    "posting",
    "control",
    "freecad_app",
    "api cli freecad_gui",
    "__main__",
)
"""Rooms from the ground floor upwards. A room imports from lower floors only, not from its neighbours."""
FLOORS = {room: floor for floor, rooms in enumerate(BY_FLOOR) for room in rooms.split()}

WITHOUT_A_DOOR = ("freecad_app", "freecad_gui")
"""FreeCAD enters these by the paths of modules that documents and its start-up name."""

WINGS = {"control": ("link", "loading", "numerical_control", "player", "simulator")}
"""Rooms whose parts each have a door of their own."""

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

FOLDERS = ("pkm_post", "tests", "tools", "benchmarks", "examples", "fuzz")
"""Whose files import names."""

ROOMS = sorted(FLOORS)
_MODULE = re.compile(r"pkm_post(\.\w+)+")


def modules(room):
    """The files of a room."""
    return sorted(PACKAGE.joinpath(room).rglob("*.py")) or [PACKAGE / f"{room}.py"]


@cache
def imports(path):
    """Modules and names that a file imports, as it writes them; inside functions, for types and by a string as well."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [(alias.name, "") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            found += [(node.module, alias.name) for alias in node.names]
        elif isinstance(node, ast.Constant) and _MODULE.fullmatch(str(node.value)):
            found.append((node.value, ""))
    return found


def imports_of_rooms(room):
    """File, room, module and name of each import of another room."""
    for path in modules(room):
        for module, name in imports(path):
            parts = module.split(".")
            if parts[0] == "pkm_post":
                target = parts[1] if len(parts) > 1 else name
                if target in FLOORS and target != room:
                    yield path.relative_to(PACKAGE), target, module, name


def door(room, module):
    """The module that an import of a room has to name."""
    wings = [f"pkm_post.{room}.{wing}" for wing in WINGS.get(room, ())]
    return module if module in wings else f"pkm_post.{room}"


def _file(module):
    path = PACKAGE.parent.joinpath(*module.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


@cache
def defined(path):
    """The names that a file defines itself, and those it lists in ``__all__``."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    found = {node.name for node in body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    for node in body:
        targets = getattr(node, "targets", [getattr(node, "target", None)])
        names = {each.id for target in targets if target for each in ast.walk(target) if isinstance(each, ast.Name)}
        found |= set(ast.literal_eval(node.value)) if names == {"__all__"} else names
    return found


@cache
def door_names(module):
    """The names that the ``__init__`` of a room imports from the house for others, not for itself."""
    tree = ast.parse(_file(module).read_text(encoding="utf-8"))
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    return {
        alias.asname or alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module.startswith("pkm_post.")
        for alias in node.names
    } - used


def test_every_file_is_in_a_room():
    there = {path.relative_to(PACKAGE).parts[0].removesuffix(".py") for path in PACKAGE.rglob("*.py")}
    assert there - {"__init__"} == set(ROOMS)


def test_the_front_door_of_the_house_imports_nothing_at_once():
    body = ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8")).body
    assert not [
        node
        for node in body
        if isinstance(node, ast.Import | ast.ImportFrom) and "pkm_post" in (getattr(node, "module", "") or "")
    ]


@pytest.mark.parametrize("room", ROOMS)
def test_imports_go_down(room):
    for path, target, module, name in imports_of_rooms(room):
        assert FLOORS[target] < FLOORS[room], f"{path} (floor {FLOORS[room]}) imports {module}.{name}"


@pytest.mark.parametrize("room", ROOMS)
def test_rooms_are_entered_by_their_doors(room):
    for path, target, module, name in imports_of_rooms(room):
        if target not in WITHOUT_A_DOOR:
            assert module == door(target, module), f"{path} imports {module}, behind the door of {target}"
            known = door_names(module) | defined(_file(module))
            assert not name or name in known, f"{path} imports {name}, no name of {module}"


@pytest.mark.parametrize("room", ROOMS)
def test_names_are_imported_from_where_they_are_defined_or_from_a_door(room):
    for path in modules(room):
        for module, name in imports(path):
            if module.startswith("pkm_post.") and name and _file(module).stem != "__init__":
                assert name in defined(_file(module)), f"{path} imports {name} from {module}, which only imports it"


@pytest.mark.slow
def test_names_of_doors_are_used():
    """Each name of a door is imported by another room, a test or a tool; those of the API are the users'."""
    files = [path for folder in FOLDERS for path in PACKAGE.parent.joinpath(folder).rglob("*.py")]
    imported = {found for path in files if path.name != "__init__.py" for found in imports(path)}
    imported |= {(module, name) for room in ROOMS for _, _, module, name in imports_of_rooms(room)}
    imported |= {("pkm_post.reading", name) for name in ("MESH_READERS", "STEP_SUFFIXES")}  # freecad_app/startup.py
    wings = {f"{room}.{wing}" for room, parts in WINGS.items() for wing in parts}
    doors = [f"pkm_post.{room}" for room in {*FLOORS, *wings} - {"api", "__main__", *WITHOUT_A_DOOR}]
    assert {(door, name) for door in doors if _file(door).stem == "__init__" for name in door_names(door)} <= imported


@pytest.mark.parametrize("room", ROOMS)
def test_optional_packages_have_one_door(room):
    for path in modules(room):
        inside = path.relative_to(PACKAGE).as_posix()
        for module, _ in imports(path):
            doors = DOORS.get(module.split(".")[0])
            assert not doors or inside.startswith(doors), f"{module} is imported by {inside}"


@pytest.mark.parametrize("room", ROOMS)
def test_modules_inside_a_room_do_not_go_in_circles(room):
    """Of the modules of a room none imports itself by way of others; imports for types only count as well."""
    imported = {name: set(inside) for name, inside in _inside(room)}
    finished, open_ones = set(), []

    def visit(name):
        assert name not in open_ones, " imports ".join([*open_ones[open_ones.index(name) :], name])
        if name not in finished:
            open_ones.append(name)
            for other in sorted(imported.get(name, ())):
                visit(other)
            finished.add(open_ones.pop())

    for name in imported:
        visit(name)


def _inside(room):
    """The modules of a room by dotted name, each with those of the same room that it imports."""
    dotted = {_dotted(path): path for path in modules(room)}
    for name, path in dotted.items():
        for_each = (full if (full := f"{module}.{each}") in dotted else module for module, each in imports(path))
        yield name, [other for other in for_each if other in dotted and other != name]


def _dotted(path):
    return ".".join(("pkm_post", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__")


def _at_first_use(room):
    """The names that a door imports when they are first used, and what it says of them for types: name and module."""
    body = ast.parse((PACKAGE / room / "__init__.py").read_text(encoding="utf-8")).body
    for node in body:
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING" and node.orelse:
            (table,) = (ast.literal_eval(each.args[1]) for each in ast.walk(node) if isinstance(each, ast.Call))
            of_table = {
                (name, f"pkm_post.{room}.{file}".removesuffix("."))
                for file, names in table.items()
                for name in names.split()
            }
            return of_table, {(alias.name, each.module) for each in node.body for alias in each.names}
    return set(), set()


@pytest.mark.parametrize("room", [room for room in ROOMS if (PACKAGE / room / "__init__.py").exists()])
def test_names_that_are_imported_at_their_first_use_are_those_for_types(room):
    names, for_types = _at_first_use(room)
    assert names == for_types
    for name, module in names:
        assert getattr(importlib.import_module(f"pkm_post.{room}"), name) is getattr(sys.modules[module], name)
        files = {path.stem for path in (PACKAGE / room).iterdir()}
        assert name not in files or module == f"pkm_post.{room}", (
            f"the file of this name takes the place of {name} when it is imported"
        )
