# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench in Simplified Chinese, as its translation says it, in a FreeCAD with a window."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from profiles import CHINESE, write_profile

TEXTS = Path(__file__).parents[2] / "resources" / "translations" / "pkm_post_zh-CN.ts"


@pytest.fixture(scope="module")
def session(scene, tmp_path_factory):
    settings = tmp_path_factory.mktemp("chinese")
    write_profile(settings, CHINESE, start_page=False)
    return scene("translations", environment=(("FREECAD_USER_HOME", str(settings)),))


@pytest.fixture(scope="module")
def chinese():
    """The translation, by context and text."""
    contexts = ElementTree.parse(TEXTS).getroot().iter("context")
    return {
        (context.findtext("name"), message.findtext("source")): message.findtext("translation")
        for context in contexts
        for message in context.iter("message")
    }


def test_buttons_are_in_the_language_that_was_chosen(session, chinese):
    found = session["buttons_are_chinese"]
    texts = [text for text, _ in found["buttons"]]
    assert chinese["PKM_Rotate", "Rotate operation"] in texts
    assert chinese["PKM_Mirror", "Mirror operation"] == "镜像操作"  # what it must say, and not the file alone
    assert "镜像操作" in texts
    assert chinese["PKM_Post", "Post to a hexapod"] in texts
    assert all(not text.isascii() and not tip.isascii() for text, tip in found["buttons"])
    assert found["tip"] == chinese["Workbench", "Post CAM jobs to hexapod machine tools"]


def test_panel_is_in_the_language_that_was_chosen(session, chinese):
    found = session["panel_is_chinese"]
    for text in ("Plane", "Direction", "Point", "Material"):
        assert chinese["SymmetryPanel", text] in found["labels"]
    assert found["climb"] == chinese["SymmetryPanel", "Keep climb milling: reverse the passes"]
    assert chinese["PKM_Mirror", "Mirror operation"] in found["undo"]
    assert found["said"] == chinese["App::Property", "Reverse each pass, to keep climb milling"]
    assert session.drew("panel.png")


def test_texts_of_tables_are_translated_as_well(session, chinese):
    labels = session["post_panel_is_chinese"]["labels"]
    for text in ("Machine", "Work offset", "Tip tolerance", "Spin", "Folder"):
        assert chinese["PostChoices", text] in labels
    assert session.drew("post.png")


def test_choices_are_translated_and_properties_keep_the_english_words(session, chinese):
    found = session["choices_are_chinese_and_properties_are_not"]
    assert found["shown"] == chinese["PKM_SurfaceFinish", "Parallel planes"]
    assert found["kept"] == "Parallel planes"
    assert found["tip"] == chinese["App::Property", "Lines that the passes follow"]
    assert found["unknown"] == []


def test_findings_are_translated_and_have_the_units_of_the_user(session):
    found = session["findings_are_chinese_and_in_the_units_of_the_user"]
    texts = [text for text in found["rows"] if "K102" in text]
    assert texts
    for text in texts:
        assert re.search(r"错误 K102：一条支链会过长：支链 \d，长了 [\d.]+ in；最长可到 [\d.]+ in；", text)
        assert "；在工作台上移动或旋转零件" in text
    (longest,) = [row for row in found["checks"] if row[0] == "最长杆长"]
    assert longest[1].startswith("-") and longest[1].endswith(" in") and longest[2].endswith(" in")
    assert all(not row[0].isascii() for row in found["checks"])
    assert session.drew("findings.png")


def test_document_keeps_its_findings_in_english(session):
    kept = session["findings_are_chinese_and_in_the_units_of_the_user"]["kept"]
    assert all(line.isascii() for line in kept)
    assert any("a strut would be too long" in line and " mm;" in line for line in kept)


def test_certificate_is_translated_and_has_the_units_of_the_user(session):
    found = session["findings_are_chinese_and_in_the_units_of_the_user"]
    rows = {row[0]: row[1:] for row in found["certificate"]}
    assert rows["刀尖偏差"][2] == "in" and float(rows["刀尖偏差"][0]) <= float(rows["刀尖偏差"][1]) < 0.01
    assert rows["支链速度"][2] == "in/min"
    assert rows["支链加速度"][2] == "in/s^2"
    assert not [row for row in found["certificate"] if row[0].isascii() or row[3] in ("mm", "um", "mm/s", "mm/s^2")]
    assert found["meaning"][0].startswith("刀具路径: 已证明: 刀尖和刀轴")
    assert all(not line.isascii() for line in found["meaning"])
    _, worst = found["play"]
    assert not worst.split(":")[0].isascii() and "0.1 in, " in worst and worst.endswith(" 1")


def test_buttons_follow_another_language_at_once(session):
    texts = [text for text, _ in session["buttons_become_english"]["buttons"]]
    assert {"Mirror operation", "Rotate operation"} <= set(texts)
    assert all(text.isascii() for text in texts)
