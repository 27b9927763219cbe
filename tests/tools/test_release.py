# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a release states is stated once, and nothing is released before it is known whose it is."""

import importlib.util
from fnmatch import fnmatch
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def release():
    spec = importlib.util.spec_from_file_location("release", ROOT / "tools" / "release.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_file_says_what_release_toml_says(release):
    assert release.differences() == []


def test_one_change_reaches_every_file(release, tmp_path, monkeypatch):
    for name in ("release.toml", *release.STATED):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        text = (ROOT / name).read_text(encoding="utf-8")
        if name == "release.toml":
            text = text.replace(release.values()["version"], "7.8.9").replace("example.invalid", "example.org")
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.setattr(release, "ROOT", tmp_path)
    assert sorted(release.differences()) == sorted(release.STATED)
    release.main(["--write"])
    assert release.differences() == []
    for name in release.STATED:
        text = (tmp_path / name).read_text(encoding="utf-8")
        assert "7.8.9" in text and "example.invalid" not in text


def test_placeholders_are_refused(release, monkeypatch):
    monkeypatch.setattr(release, "has_changes", lambda: False)
    given = {
        "version": "9.9.9",
        "date": "2030-01-01",
        "maintainer": "PLACEHOLDER",
        "repository": "https://example.invalid",
    }
    monkeypatch.setattr(release, "values", lambda: given)
    monkeypatch.setattr(release, "differences", lambda: ["package.xml"])
    assert list(release.lacking()) == [
        "release.toml: maintainer is a placeholder: PLACEHOLDER",
        "release.toml: repository is a placeholder: https://example.invalid",
        "package.xml does not say what release.toml says: python3 tools/release.py --write",
        "CHANGELOG.md has no line ## [9.9.9] - 2030-01-01",
    ]
    assert release.main(["--check"]) == 1


def left_out(name):
    """Whether .gitattributes leaves a file out of archives."""
    lines = (ROOT / ".gitattributes").read_text(encoding="utf-8").splitlines()
    patterns = [line.split()[0].lstrip("/") for line in lines if line.endswith(" export-ignore")]
    return any(fnmatch(name, pattern) or fnmatch(name, f"{pattern}/*") for pattern in patterns)


def test_an_archive_of_the_add_on_has_what_freecad_needs_and_no_more():
    needed = ["Init.py", "InitGui.py", "package.xml", "LICENSE", "README.md", "pyproject.toml", "tools/run_script.py"]
    for folder in ("pkm_post", "postprocessors", "resources/icons", "resources/machines"):
        needed += [str(file.relative_to(ROOT)) for file in (ROOT / folder).rglob("*.*")]
    assert [name for name in needed if left_out(name)] == []
    for name in ("tests/machines.py", "docs/pictures/machine.png", "tools/freecad", ".ci/run", "fuzz/part_programs.py"):
        assert (ROOT / name).is_file() and left_out(name)


def test_the_addon_manager_finds_no_macros_to_copy():
    assert list((ROOT / "examples").rglob("*.[fF][cC][mM]acro")) == []
