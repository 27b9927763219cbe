# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench in Simplified Chinese, as its translation says it, in a FreeCAD with a window."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import FreeCAD
import pytest

TEXTS = Path(__file__).parents[2] / "resources" / "translations" / "pkm_post_zh-CN.ts"
SETTINGS = """<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<FCParameters>
  <FCParamGroup Name="Root">
    <FCParamGroup Name="BaseApp">
      <FCParamGroup Name="Preferences">
        <FCParamGroup Name="General">
          <FCText Name="Language">{}</FCText>
        </FCParamGroup>
      </FCParamGroup>
    </FCParamGroup>
  </FCParamGroup>
</FCParameters>
"""


@pytest.fixture(scope="module")
def session(scene, tmp_path_factory):
    is_older = [int(number) for number in FreeCAD.Version()[:2]] < [1, 1]
    language = "Chinese Simplified" if is_older else "Chinese (Simplified)"
    settings = tmp_path_factory.mktemp("chinese")
    (settings / "user.cfg").write_text(SETTINGS.format(language), encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FREECAD_USER_HOME", str(settings))
        yield scene("translations")


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
    assert texts[:2] == [chinese["PKM_Mirror", "Mirror operation"], chinese["PKM_Rotate", "Rotate operation"]]
    assert texts[0] == "镜像操作"  # what it must say, and not the file alone
    assert chinese["PKM_Post", "Post to a hexapod"] in texts
    assert all(not text.isascii() and not tip.isascii() for text, tip in found["buttons"])
    assert found["tip"] == chinese["Workbench", "Post CAM jobs to hexapod machine tools"]


def test_panel_is_in_the_language_that_was_chosen(session, chinese):
    found = session["panel_is_chinese"]
    for text in ("Plane", "Direction", "Point", "Material"):
        assert chinese["SymmetryPanel", text] in found["labels"]
    assert found["climb"] == chinese["SymmetryPanel", "Keep climb milling: run passes the other way"]
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


def test_buttons_follow_another_language_at_once(session):
    texts = [text for text, _ in session["buttons_become_english"]["buttons"]]
    assert texts[:2] == ["Mirror operation", "Rotate operation"]
    assert all(text.isascii() for text in texts)
