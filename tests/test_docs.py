# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the documents say of files, modules, names, floors and codes is so."""

import ast
import re
import runpy
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from machines import without_jerk
from programs import program
from test_floors import FLOORS

from pkm_post.certificate import certify
from pkm_post.geometry import unit
from pkm_post.machine import find_machine
from pkm_post.machine.description.reader import read_machine
from pkm_post.model import EventKind, Kind
from pkm_post.model.certificate import Tolerances
from pkm_post.model.rules import RULES
from pkm_post.planning import plan
from pkm_post.reading import ReadingOptions, read_part_program
from pkm_post.toolpath.place import place
from pkm_post.writing.controllers import pmac

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "pkm_post"
DOCS = ROOT / "docs"
TOP = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")
PAGES = [*(ROOT / name for name in TOP), *sorted(DOCS.glob("*.md"))]

LINK = re.compile(r"\]\(([^)\s]+)\)")
FENCED = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
HEADING = re.compile(r"^#+ +(.*?) *$", re.MULTILINE)
PYTHON_FILE = re.compile(r"`([\w./-]+\.py)`")
DOTTED = re.compile(r"`(\w+(?:\.\w+)+)(?:\.\*|\(.*?\))?`")
FLOOR_ROW = re.compile(r"^\| *(\d+) *\| *`(\w+)` *\|", re.MULTILINE)
CODE = re.compile(r"\b[JMKNTV]1\d\d\b(?![.:\d])|\bC10\d\b(?![.:\d])|\bF10[12]\b(?![.:\d])")


def text(page):
    return page.read_text(encoding="utf-8")


def anchors(page):
    """The anchors a forge makes of the headings of a page."""
    headings = HEADING.findall(FENCED.sub("", text(page)))
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def dead_links(page):
    for link in LINK.findall(FENCED.sub("", text(page))):
        if re.match(r"[a-z]+:", link):
            continue
        file, _, anchor = link.partition("#")
        target = page.parent / file if file else page
        if not target.exists() or (anchor and target.suffix == ".md" and anchor not in anchors(target)):
            yield link


@cache
def bindings(file):
    """What a module binds at its top: by name a class or function, or the module a name comes from, or None."""
    bound = {}
    body = ast.parse(file.read_text(encoding="utf-8")).body
    for node in (each for top in body for each in (top.body if isinstance(top, ast.If) else [top])):
        if isinstance(node, ast.ImportFrom):
            source = node.module.split(".")
            bound |= {alias.asname or alias.name: source for alias in node.names}
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            bound[node.name] = node
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            bound |= dict.fromkeys(assigned(node))
    return bound


def assigned(node):
    targets = node.targets if isinstance(node, ast.Assign) else [node.target]
    return [target.id for target in targets if isinstance(target, ast.Name)]


def has_name(file, names):
    """Whether a module binds a name, and that a second one if it is a class."""
    if not names:
        return True
    if not file.exists() or names[0] not in bindings(file):
        return False
    bound = bindings(file)[names[0]]
    if isinstance(bound, list) and bound[0] == "pkm_post":
        return exists([*bound[1:], *names])
    return len(names) == 1 or (isinstance(bound, ast.ClassDef) and names[1] in members(bound))


def members(node):
    methods = [item.name for item in node.body if isinstance(item, ast.FunctionDef)]
    fields = [item for item in node.body if isinstance(item, ast.Assign | ast.AnnAssign)]
    return [*methods, *(name for item in fields for name in assigned(item))]


def exists(parts):
    """Whether a dotted name below the package is a room, a module, a name in one, or one in a class of one."""
    here = PACKAGE
    for index, part in enumerate(parts):
        if (here / f"{part}.py").exists():
            return has_name(here / f"{part}.py", parts[index + 1 :])
        if (here / part).is_dir():
            here /= part
        else:
            return has_name(here / "__init__.py", parts[index:])
    return True


def wrong_names(page):
    for path in PYTHON_FILE.findall(text(page)):
        if not any((folder / path).exists() for folder in (ROOT, PACKAGE, page.parent)):
            yield path
    for name in DOTTED.findall(text(page)):
        parts = name.split(".")
        if parts[-1] not in ("png", "py") and (parts[0] == "pkm_post" or parts[0] in FLOORS):
            parts = parts[1:] if parts[0] == "pkm_post" else parts
            if not exists(parts):
                yield name


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    assert not list(dead_links(page))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_modules_and_names_exist(page):
    assert not list(wrong_names(page))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_codes_exist(page):
    assert not sorted(set(CODE.findall(text(page))) - set(RULES))


def test_wrong_names_and_dead_links_are_found_and_right_ones_pass(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("`feed/path.py` `pkm_post.planning.tool_path.PATH` `model.Machine.colour` [x](gone.md)")
    assert list(wrong_names(page)) == ["feed/path.py", "pkm_post.planning.tool_path.PATH", "model.Machine.colour"]
    assert list(dead_links(page)) == ["gone.md"]
    names = (
        "`planning/tool_path.py` `pkm_post.planning.tool_path.ToolPath` `planning.FeedPlan.path` `model.Machine.name`"
    )
    page.write_text(f"{names} [x](page.md)")
    assert not list(wrong_names(page)) and not list(dead_links(page))


def test_every_page_is_in_the_index():
    linked = set(LINK.findall(text(DOCS / "README.md")))
    assert {page.name for page in DOCS.glob("*.md")} - {"README.md"} <= linked


def test_floors_are_those_of_the_test():
    reported = {room: int(floor) for floor, room in FLOOR_ROW.findall(text(DOCS / "architecture.md"))}
    rooms = {path.stem for path in PACKAGE.iterdir() if path.suffix == ".py" or any(path.glob("*.py"))}
    assert reported == {room: FLOORS[room] for room in rooms - {"__init__"}}


def test_diagnostics_page_is_up_to_date():
    page = runpy.run_path(str(ROOT / "tools" / "make_diagnostics_doc.py"))["page"]
    assert text(DOCS / "diagnostics.md") == page(RULES), "run tools/make_diagnostics_doc.py"


@pytest.mark.parametrize(
    ("language", "suffix", "reading", "lengths"),
    [("gcode", ".ngc", ReadingOptions(axis_words="vector"), {1: 120.0}), ("cldata", ".cls", ReadingOptions(), {})],
)
def test_the_journey_begins_the_same_at_every_door(language, suffix, reading, lengths, tmp_path):
    (source,) = re.findall(rf"^```{language}\n(.*?)^```$", text(DOCS / "journey.md"), re.MULTILINE | re.DOTALL)
    (tmp_path / f"part{suffix}").write_text(source, encoding="ascii")
    made, _ = read_part_program(tmp_path / f"part{suffix}", replace(reading, lengths=lengths))
    np.testing.assert_allclose(made.position[1], [4, 3, 50])
    np.testing.assert_allclose(made.tool_axis[1], unit(np.array([0.173648, 0, 0.984808])), atol=1e-9)
    assert (made.kind[1], made.feed[1], made.tools[1].length) == (Kind.LINE, 10.0, 120.0)
    assert [(event.row, event.kind, event.value) for event in made.events] == [
        (0, EventKind.TOOL_CHANGE, 1), (0, EventKind.SPINDLE, 12000), (2, EventKind.SPINDLE, 0),
    ]  # fmt: skip
    assert f"Ours is line {made.line[1]}." in text(DOCS / "journey.md")


def test_the_journey_is_one_that_was_made():
    # The job of docs/journey.md without its events, which change nothing of the motion.
    machine = without_jerk(read_machine(find_machine("example_6tps"))[0])
    tolerances = Tolerances(1e-3, np.radians(1e-3))
    made = program([[0, 0, 50], [4, 3, 50]], unit(np.array([[0, 0, 1], [0.173648, 0, 0.984808]])), feed=10.0, events=())
    trajectory, _ = place(made, machine, machine.work_offsets["G54"])
    planned, _ = plan(trajectory, machine, tolerances)
    motion, struts = planned.motion, planned.struts
    settings = pmac.PmacSettings.of(machine.controller)
    written = pmac.program_text(struts, settings, [])
    played, _ = pmac.read_program(written, settings, "journey.pmc")
    certificate, _ = certify(played, "journey.pmc", trajectory, machine, motion, tolerances)

    reported = text(DOCS / "journey.md")
    assert "\n".join(re.findall(r"^    (PVT\d+|A\d.*)$", reported, re.MULTILINE)) in written
    assert f"There are {len(motion)} knots" in reported
    for found in certificate.findings[1:]:
        limit = f"{'at least ' if found.is_least else ''}{found.limit:.4g} {found.unit}"
        assert f"| {found.name} | {found.value:.4g} {found.unit} | {limit} |" in reported
