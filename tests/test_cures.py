# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cures name what exists: options, commands, entries of machine files, pages, and codes."""

import argparse
import ast
import re
from pathlib import Path

import pytest

from pkm_post.cli import _parser
from pkm_post.machine.description.fields import FIELDS
from pkm_post.model.rules import RULES

ROOT = Path(__file__).parents[1]
SECTIONS = {field.entry.partition(".")[0] for field in FIELDS if "." in field.entry}
ENTRIES = {field.entry for field in FIELDS} | {field.entry.rpartition(".")[0] for field in FIELDS}


def parsers(parser):
    """A parser and those of its commands."""
    yield parser
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for each in action.choices.values():
                yield from parsers(each)


EVERY_PARSER = list(parsers(_parser()))
OPTIONS = {option for parser in EVERY_PARSER for option in parser._option_string_actions}
COMMANDS = {parser.prog.partition("pkm_post ")[2] for parser in EVERY_PARSER}


def buttons():
    """Titles of the commands of the workbench, read without FreeCAD."""
    tree = ast.parse((ROOT / "pkm_post" / "freecad_gui" / "commands.py").read_text(encoding="utf-8"))
    return {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)}


@pytest.mark.parametrize("code", RULES)
def test_what_a_cure_names_exists(code):
    cure = RULES[code].cure
    assert [option for option in re.findall(r"--[a-z][a-z-]*[a-z]", cure) if option not in OPTIONS] == []
    assert [page for page in re.findall(r"docs/[a-z-]+\.md", cure) if not (ROOT / page).exists()] == []
    named = re.findall(r"\b([a-z_]+)\.([a-z_]+)\b", cure)
    assert [f"{a}.{b}" for a, b in named if a in SECTIONS and f"{a}.{b}" not in ENTRIES] == []
    assert [other for other in re.findall(r"\b[A-FH-Z][0-9]{3}\b", cure) if other not in RULES] == []
    for words in re.findall(r"pkm_post ([a-z -]+)", cure):
        assert any(command and f"{words} ".startswith(f"{command} ") for command in COMMANDS), words


def test_the_workbench_has_the_button_that_messages_name():
    from pkm_post.system import packages

    assert "Install packages" in buttons()
    assert "choose Install packages in the workbench PKM Post" in Path(packages.__file__).read_text(encoding="utf-8")


def test_these_checks_see_something():
    cures = " ".join(rule.cure for rule in RULES.values())
    assert {"--tool-length", "--known-hosts"} <= set(re.findall(r"--[a-z][a-z-]*[a-z]", cures)) & OPTIONS
    assert "machine list" in COMMANDS and "install" in COMMANDS
    assert "--no-such-option" not in OPTIONS
