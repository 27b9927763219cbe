# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every text that users see is in each translation and translated, and nothing else is; no Qt is needed to see that."""

import ast
import re
import runpy
import struct
import xml.etree.ElementTree as ElementTree
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from pkm_post.control.link import NOT_AT_REST
from pkm_post.control.link.status_bits import PowerMotorBits, PowerSystemBits
from pkm_post.control.numerical_control import Interlock
from pkm_post.model import RULES, Extent, Topic

ROOT = Path(__file__).parents[1]
SOURCES = [file for room in ("freecad_app", "freecad_gui") for file in (ROOT / "pkm_post" / room).rglob("*.py")]
TRANSLATIONS = sorted((ROOT / "resources" / "translations").glob("*.ts"))
MARKS = ("translate", "QT_TRANSLATE_NOOP")


def calls(tree, names):
    """The calls of functions or methods with one of these names."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if name in names:
                yield name, node


def literal(node):
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


@cache
def trees():
    return [(file.relative_to(ROOT), ast.parse(file.read_text(encoding="utf-8"))) for file in SOURCES]


@cache
def marked():
    """Context and text of every text in the sources; a text without a literal context is one that lupdate loses."""
    found, lost = set(), []
    for file, tree in trees():
        for name, call in calls(tree, MARKS):
            if len(call.args) < 2:
                continue  # str.translate
            context, text = literal(call.args[0]), literal(call.args[1])
            if context is not None and text is not None:
                found.add((context, text))
            elif text is not None or name == "QT_TRANSLATE_NOOP" or isinstance(call.args[1], ast.JoinedStr):
                lost.append(f"{file}:{call.lineno}")
    return found, lost


@cache
def core_texts():
    """Context and text of what the core says: causes, cures, phrases."""
    tool = runpy.run_path(str(ROOT / "tools" / "core_texts.py"))
    return {(tool["CONTEXT"], text) for text in tool["core_texts"]()}


def wanted():
    return marked()[0] | core_texts()


def messages(file):
    """Context, text and the element of the translation."""
    for context in ElementTree.parse(file).getroot().iter("context"):
        for message in context.iter("message"):
            yield context.findtext("name"), message.findtext("source"), message.find("translation")


def test_lupdate_sees_every_text():
    found, lost = marked()
    assert lost == []
    assert len(found) > 400


def test_core_texts_are_rules_words_of_the_certificate_states_of_the_machine_and_phrases():
    texts = {text for _, text in core_texts()}
    assert {text for rule in RULES.values() for text in (rule.cause, rule.cure)} <= texts
    assert {word.value for table in (Topic, Extent, Interlock) for word in table} <= texts
    assert {*PowerMotorBits.FAULT_TEXTS.values(), *PowerSystemBits.FAULT_TEXTS.values(), *NOT_AT_REST} <= texts
    assert {"deviation of the tool tip", "strut {part} by {by}; it extends to {limit}"} <= texts
    assert {"a number from {} to {}", "one of {}", "names out of {}", "G and M codes such as M21,G187"} <= texts


@pytest.mark.parametrize("file", TRANSLATIONS, ids=lambda file: file.stem)
def test_options_and_entries_that_a_cure_names_are_in_its_translation(file):
    names, bad = re.compile(r"--[a-z-]+|[a-z_]+\.[a-z_]+(?:\.[a-z_]+)*|[A-Z]\d{3}\b|\b[A-Z]+/[A-Z]+\b"), []
    for context, text, translation in messages(file):
        if context == "Core" and sorted(names.findall(text)) != sorted(names.findall(translation.text)):
            bad.append((text, translation.text))
    assert bad == []


def test_there_is_simplified_chinese():
    # FreeCAD asks for *_zh-CN.qm, with the name that it has for the language itself
    assert "pkm_post_zh-CN.ts" in [file.name for file in TRANSLATIONS]


@pytest.mark.parametrize("file", TRANSLATIONS, ids=lambda file: file.stem)
def test_translation_has_the_texts_of_the_sources_and_no_others(file):
    listed = [(context, text) for context, text, _ in messages(file)]
    assert len(listed) == len(set(listed))
    assert wanted() - set(listed) == set(), "run make translations, and translate what is new"
    assert set(listed) - wanted() == set(), "run make translations"


@pytest.mark.parametrize("file", TRANSLATIONS, ids=lambda file: file.stem)
def test_translation_is_finished(file):
    open_ones = [text for _, text, translation in messages(file) if translation.get("type") or not translation.text]
    assert open_ones == []


@pytest.mark.parametrize("file", TRANSLATIONS, ids=lambda file: file.stem)
def test_places_for_numbers_and_names_are_kept(file):
    holes, bad = re.compile(r"\{[^}]*\}"), []
    for _, text, translation in messages(file):
        if sorted(holes.findall(text)) != sorted(holes.findall(translation.text or "")):
            bad.append(text)
        if text.count("\n") != (translation.text or "").count("\n"):
            bad.append(text)
    assert bad == []


def _elf_hash(text):
    """The hash by which Qt finds a message (System V ABI, chapter 5, "Hash Table"; 0 is written as 1)."""
    value = 0
    for byte in text.encode():
        value = (value << 4) + byte
        value ^= (value & 0xF0000000) >> 24
        value &= 0x0FFFFFFF
    return value or 1


def _compiled_messages(compiled):
    """The fields of each message by its hash and context."""
    tool = runpy.run_path(str(ROOT / "tools" / "make_compact_translation.py"))
    found = tool["sections"](compiled)
    for number, offset in struct.iter_unpack(">II", found[tool["HASHES"]]):
        fields = dict(tool["message"](found[tool["MESSAGES"]], offset))
        yield (number, fields[tool["CONTEXT"]].decode(), fields.get(tool["TEXT"])), fields[tool["TRANSLATION"]]


@pytest.mark.parametrize("file", TRANSLATIONS, ids=lambda file: file.stem)
def test_compiled_file_has_every_translation(file):
    # Qt writes each translation as UTF-16, the most significant byte first
    listed = {
        (context, text): (translation.text or "").encode("utf-16-be") for context, text, translation in messages(file)
    }
    compiled = dict(_compiled_messages(file.with_suffix(".qm").read_bytes()))
    keys = {(context, text): (_elf_hash(text), context) for context, text in listed}
    missing = [
        text
        for (context, text), translation in listed.items()
        if translation not in (compiled.get((*keys[context, text], written)) for written in (None, text.encode()))
    ]
    assert missing == [], "run make translations"
    assert len(compiled) == len(listed), "run make translations"


@pytest.mark.parametrize("file", TRANSLATIONS, ids=lambda file: file.stem)
def test_compiled_file_has_the_english_where_a_hash_is_not_enough(file):
    compiled = [key for key, _ in _compiled_messages(file.with_suffix(".qm").read_bytes())]
    times = Counter(number for number, _, _ in compiled)
    assert len(compiled) > 1000
    for number, context, text in compiled:
        assert (text is None) == (times[number] == 1 and context not in ("App::Property", "Workbench"))


def test_commands_say_their_own_name_as_context():
    # FreeCAD looks up the texts of a command by its name
    (tree,) = (tree for file, tree in trees() if file.name == "commands.py" and file.parent.name == "freecad_gui")
    rows = [call for _, call in calls(tree, ("Command", "WindowCommand", "PanelCommand"))]
    assert len(rows) > 8
    for row in rows:
        contexts = {literal(call.args[0]) for _, call in calls(row, ("QT_TRANSLATE_NOOP",))}
        assert contexts == {literal(row.args[0])}


def test_what_is_said_of_properties_is_marked():
    # FreeCAD looks up the tool tips of properties in this context
    rows = []
    for file, tree in trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.Tuple) and len(node.elts) == 5 and _is_property(node.elts[0]):
                rows.append((f"{file}:{node.lineno}", node.elts[3]))
    assert len(rows) > 90
    unmarked = [
        place for place, said in rows if not (isinstance(said, ast.Call) and literal(said.args[0]) == "App::Property")
    ]
    assert unmarked == []


def _is_property(node):
    return (literal(node) or "").startswith("App::Property") or getattr(node, "id", "") == "_LINK"
