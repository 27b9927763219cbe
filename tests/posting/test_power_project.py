# SPDX-License-Identifier: LGPL-2.1-or-later
"""A project for the IDE of the Power PMAC: its files fit together, and a controller that loads them has the program."""

import configparser
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path, PurePosixPath

import pytest

from pkm_post.cli import main
from pkm_post.control.link.program import compare_listing, parse_power_program
from pkm_post.control.simulator import PowerPmac
from pkm_post.control.simulator.gpascii_shell import refused_line
from pkm_post.machine import find_machine

EXAMPLE = Path(__file__).parents[2] / "examples" / "first.ngc"
NAMESPACE = "{http://schemas.microsoft.com/developer/msbuild/2003}"
ROOT = PurePosixPath("/var/ftp/usrflash/Project")


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    """The machine with a Power PMAC, and a program that was posted for it."""
    folder = tmp_path_factory.mktemp("posted")
    machine = folder / "shop.toml"
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    machine.write_text(text.replace('kind = "turbo_pmac"', 'kind = "power_pmac"'), encoding="utf-8")
    arguments = ["--machine", str(machine), "--tool-length", "1=120", "--out", str(folder / "out")]
    assert main(["post", str(EXAMPLE), *arguments]) == 0
    return machine, folder / "out" / "first.pmc"


def exported(machine, out, *more):
    return main(["machine", "export", str(machine), "--to", "power-pmac-project", "--out", str(out), *more])


def load_list(project):
    """The files that the controller loads, in order, by their place in the project."""
    ini = configparser.ConfigParser(interpolation=None)
    ini.read(project / "Configuration" / "pp_proj.ini", encoding="utf-8")
    programs = ini["PMAC_PROGRAMS"]
    files = [programs[f"file{number}"] for number in range(1, int(programs["last_file_number"]) + 1)]
    return [project / PurePosixPath(file).relative_to(ROOT) for file in files]


def test_a_program_and_its_set_up_are_loaded_in_order(posted, tmp_path):
    machine, program = posted
    assert exported(machine, tmp_path, "--program", str(program)) == 0
    files = load_list(tmp_path / "shop" / "shop")
    assert [file.parent.name for file in files] == ["Global Includes", "Motion Programs"]
    assert files[0].read_text() == program.with_name("first-setup.cfg").read_text()
    assert files[1].read_bytes() == program.read_bytes()
    controller = PowerPmac()
    for file in files:
        assert refused_line(controller, file.read_text().splitlines()) is None
    held = controller.controller.memory.programs[10].source
    assert compare_listing(parse_power_program(program.read_text()).lines, held).same
    assert controller.controller.systems[0].axes.definitions[6].text() == "10000W-10078869"


@pytest.mark.parametrize("with_program", [True, False])
def test_solution_and_project_name_what_is_there(posted, tmp_path, with_program):
    machine, program = posted
    assert exported(machine, tmp_path, *(["--program", str(program)] if with_program else [])) == 0
    project = tmp_path / "shop" / "shop"
    tree = ElementTree.parse(project / "shop.ppproj").getroot()
    listed = [item.get("Include") for kind in ("Content", "None") for item in tree.iter(NAMESPACE + kind)]
    files = {path.relative_to(project).as_posix() for path in project.rglob("*") if path.is_file()} - {"shop.ppproj"}
    assert sorted(place.replace("\\", "/") for place in listed) == sorted(files)
    guid = tree.find(f"{NAMESPACE}PropertyGroup/{NAMESPACE}ProjectGuid").text
    solution = (tmp_path / "shop" / "shop.PowerPmacSuite_sln").read_text()
    assert f'"shop", "shop\\shop.ppproj", "{{{guid}}}"' in solution and solution.count(guid) == 5
    assert re.fullmatch(r"[0-9A-F]{8}(?:-[0-9A-F]{4}){3}-[0-9A-F]{12}", guid)


def test_the_kinematics_are_those_of_the_file_alone(tmp_path):
    assert exported("example_6tps", tmp_path / "project") == 0
    assert main(["machine", "export", "example_6tps", "--to", "power-pmac", "--out", str(tmp_path / "alone")]) == 0
    (file,) = load_list(tmp_path / "project" / "example_6tps" / "example_6tps")
    assert file.parent.name == "Kinematic Routines"
    assert file.read_bytes() == (tmp_path / "alone" / "example_6tps-kinematics.cfg").read_bytes()
    assert (file.parents[2] / "Documentation" / "note.txt").read_text().count("- [ ]") > 12


def test_the_same_input_gives_the_same_bytes(posted, tmp_path):
    machine, program = posted
    for out in ("one", "two"):
        assert exported(machine, tmp_path / out, "--program", str(program)) == 0
    contents = [
        {path.relative_to(tmp_path / out): path.read_bytes() for path in (tmp_path / out).rglob("*") if path.is_file()}
        for out in ("one", "two")
    ]
    assert contents[0] == contents[1] and len(contents[0]) == 8


def test_a_project_that_is_there_is_left_as_it_is(tmp_path, capsys):
    (tmp_path / "example_6tps").mkdir()
    (tmp_path / "example_6tps" / "mine.txt").write_text("mine")
    assert exported("example_6tps", tmp_path) == 1
    assert "error F119" in capsys.readouterr().err
    assert [path.name for path in tmp_path.rglob("*")] == ["example_6tps", "mine.txt"]


@pytest.mark.parametrize(
    ("change", "code"),
    [(("A1012.576633", "A1012.576634"), "C110"), (("open prog 10", "open prog 11"), "C110")],
)
def test_a_program_that_is_not_certified_is_refused(posted, tmp_path, change, code, capsys):
    machine, program = posted
    other = tmp_path / "other" / "first.pmc"
    other.parent.mkdir()
    other.write_text(program.read_text().replace(*change), newline="\n")
    assert exported(machine, tmp_path / "out", "--program", str(other)) == 1
    assert code in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_a_program_belongs_to_a_project_alone(tmp_path, capsys):
    out = ["--out", str(tmp_path / "out"), "--program", "part.pmc"]
    assert main(["machine", "export", "example_6tps", "--to", "power-pmac", *out]) == 2
    assert "--program" in capsys.readouterr().err and not (tmp_path / "out").exists()
