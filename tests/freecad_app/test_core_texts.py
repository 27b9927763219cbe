# SPDX-License-Identifier: LGPL-2.1-or-later
"""Core texts in the language and the units of the user: as in the translation, with the values of the message."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from FreeCAD import Units

from pkm_post.control.link import port_named
from pkm_post.control.link.links import lost_link
from pkm_post.freecad_app import core_texts
from pkm_post.freecad_app.arguments import parse_arguments
from pkm_post.freecad_app.core_texts import (
    exception_text,
    fault_text,
    meaning_lines,
    place_text,
    shown,
    stored_fault,
)
from pkm_post.freecad_app.user_units import amount_text, in_user_units
from pkm_post.freecad_gui.quantities import length_text
from pkm_post.model import RULES, Amount, Diagnostic, Pattern, Phrase, Place, Refused

TEXTS = Path(__file__).parents[2] / "resources" / "translations" / "pkm_post_zh-CN.ts"
STANDARD, IMPERIAL = 0, 3
FOUND = Pattern("strut {part} by {by}; it extends to {limit}").phrase(
    part=3, by=Amount(25.4, "mm", ".3f"), limit=Amount(508.0, "mm", "g")
)
PLACE = Place("blade.nc", "Finish", 12, 4)


@pytest.fixture
def chinese(monkeypatch):
    """What Qt does with the translation."""
    texts = {
        (context.findtext("name"), message.findtext("source")): message.findtext("translation")
        for context in ElementTree.parse(TEXTS).getroot().iter("context")
        for message in context.iter("message")
    }
    monkeypatch.setattr(core_texts, "translate", lambda context, text: texts.get((context, text), text))


@pytest.fixture
def schema():
    """Set the user's schema of units; the test leaves the one before."""
    before = Units.getSchema()
    yield Units.setSchema
    Units.setSchema(before)


@pytest.mark.parametrize("place", [PLACE, Place("m.toml"), Place("m: error.toml", line=3)], ids=str)
def test_without_a_translation_a_fault_is_its_english_line_and_is_found_again_in_it(place):
    for code in RULES:
        fault = Diagnostic(code, place, "found: this; that")
        assert fault_text(fault) == str(fault)
        stored = stored_fault(str(fault))
        assert (stored.code, stored.found, str(stored)) == (code, fault.found, str(fault))


def test_lines_that_are_no_faults_of_today_are_not_taken_for_them():
    for line in ("K102", "a: error K102: other cause: x; y", "a: error X999: cause: x; y", ""):
        assert stored_fault(line) is None


def test_fault_has_place_cause_message_and_cure_in_the_language_of_the_user(chinese, schema):
    schema(STANDARD)
    text = fault_text(Diagnostic("K102", PLACE, FOUND))
    assert text.startswith("blade.nc: Finish: 第 12:4 行：错误 K102：一条支链会过长：支链 3，长了 25.4 mm；")
    assert "；最长可到 508 mm；" in text
    assert "--place" in text
    assert exception_text(Refused([Diagnostic("K102", PLACE, FOUND)])) == text


def test_words_of_the_input_are_not_translated(chinese):
    assert "：part；" in fault_text(Diagnostic("K102", PLACE, "part"))
    assert shown(Phrase("{} and {}", "strut", Phrase("part"))) == "strut 与 零件"


def test_the_reason_against_an_argument_is_in_the_language_of_the_user(chinese):
    with pytest.raises(Refused) as refused:
        parse_arguments("--work-offset 0,0", Place("job"))
    text = fault_text(refused.value.diagnostics[0])
    assert "：--work-offset：应为 X,Y,Z 或 X,Y,Z,DEG，实为 '0,0'（位于 '--work-offset 0,0'）；" in text
    with pytest.raises(Refused) as refused:
        parse_arguments("--machine 'a", Place("job"))
    assert '：引号没有闭合："--machine \'a"；' in fault_text(refused.value.diagnostics[0])


def test_why_a_port_is_none_is_in_the_language_of_the_user(chinese):
    with pytest.raises(ValueError, match="expected serial:DEVICE") as refused:
        port_named("usb:1")
    assert exception_text(refused.value).startswith("端口：应为 serial:DEVICE, ")


def test_why_a_link_is_lost_is_in_the_language_of_the_user(chinese):
    lost = lost_link("host", ConnectionRefusedError(111, "Connection refused"), 1025)
    assert exception_text(lost) == "host，端口 1025：连接被拒绝"
    assert exception_text(OSError(28, "No space")) == "[Errno 28] No space"


def test_numbers_of_a_message_have_the_units_of_the_user(schema):
    schema(IMPERIAL)
    assert shown(FOUND) == "strut 3 by 1 in; it extends to 20 in"
    assert str(FOUND) == "strut 3 by 25.400 mm; it extends to 508 mm"


@pytest.mark.parametrize(
    ("values", "unit", "metric", "imperial"),
    [
        ((0.00123, 0.01), "mm", (("1.23", "10"), "µm"), (("4.843e-05", "0.0003937"), "in")),
        ((25.4, 2.54), "um", (("25.4", "2.54"), "µm"), (("0.001", "0.0001"), "in")),
        ((254.0, 508.0), "mm", (("254", "508"), "mm"), (("10", "20"), "in")),
        ((42.3333333, None), "mm/s", (("42.33", "–"), "mm/s"), (("100", "–"), "in/min")),
        ((25400.0, 2540.0), "mm/s^3", (("25400", "2540"), "mm/s^3"), (("1000", "100"), "in/s^3")),
        ((9999.6, -9999.96), "N", (("10000", "-10000"), "N"), (("10000", "-10000"), "N")),
        ((0.5, 1.0), "degrees", (("0.5", "1"), "°"), (("0.5", "1"), "°")),
        ((4.0, float("inf")), "ms", (("4", "–"), "ms"), (("4", "–"), "ms")),
    ],
)
def test_compared_numbers_have_one_unit_of_the_user(schema, values, unit, metric, imperial):
    schema(STANDARD)
    assert in_user_units(values, unit) == metric
    schema(IMPERIAL)
    assert in_user_units(values, unit) == imperial


def test_zero_has_no_sign(schema):
    schema(IMPERIAL)
    assert [length_text(value) for value in (-1e-9, -0.0, -25.4)] == ["0.00 in", "0.00 in", "-1.00 in"]


def test_amount_has_no_blank_before_degrees(schema):
    schema(STANDARD)
    assert [amount_text(1.5, "degrees"), amount_text(0.0, "mm"), amount_text(0.25, "")] == ["1.5°", "0 mm", "0.25"]


def test_meaning_has_a_line_for_each_topic(chinese):
    rows = [
        {"topic": "tool path", "what": "feed", "extent": "proven"},
        {"topic": "collisions", "what": "strut and part", "extent": "not covered"},
        {"topic": "tool path", "what": "events", "extent": "proven"},
    ]
    assert meaning_lines(rows) == ["刀具路径: 已证明: 进给, 事件", "碰撞: 未涵盖: 支链与零件"]


def test_place_without_line_is_its_file(chinese):
    assert place_text(Place("m.toml")) == "m.toml"
