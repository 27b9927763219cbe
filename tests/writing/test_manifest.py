# SPDX-License-Identifier: LGPL-2.1-or-later
"""A manifest is given out for files that were posted together, and for nothing else."""

import hashlib
import json

import pytest

from pkm_post.writing import manifest

RESULTS = {
    "part.pmc": b"OPEN PROG 1 CLEAR\nCLOSE\n",
    "part-part2.pmc": b"OPEN PROG 2 CLEAR\nCLOSE\n",
    "part-report.json": b"{}\n",
    "part.pkmt": bytes(range(256)),
}


@pytest.fixture
def folder(tmp_path):
    """A folder with the results of one posting."""
    for name, content in RESULTS.items():
        (tmp_path / name).write_bytes(content)
    manifest.write(tmp_path, "part")
    return tmp_path


def refusal(file):
    """Code and words of the one thing that stands against a file."""
    found, (fault,) = manifest.check(file)
    assert found is None
    return fault.code, fault.found


@pytest.mark.parametrize("name", RESULTS)
def test_each_result_has_the_manifest_of_its_posting(folder, name):
    found, faults = manifest.check(folder / name)
    assert faults == ()
    assert found.path == folder / "part-manifest.json"
    assert dict(found.files) == {name: hashlib.sha256(content).hexdigest() for name, content in RESULTS.items()}
    assert found.fingerprint_of(name.upper()) == manifest.fingerprint(name, RESULTS[name])


def test_it_says_what_wrote_it_and_is_the_same_each_time(folder):
    written = (folder / "part-manifest.json").read_bytes()
    assert json.loads(written)["product"].startswith("PKM Post ")
    assert json.loads(written)["format"] == 1
    (folder / "part-manifest.json").unlink()
    manifest.write(folder, "part")
    assert (folder / "part-manifest.json").read_bytes() == written


@pytest.mark.parametrize("changed", RESULTS)
def test_no_result_is_accepted_beside_one_that_has_changed(folder, changed):
    (folder / changed).write_bytes(RESULTS[changed].replace(b"\n", b" \n", 1))
    assert {refusal(folder / name) for name in RESULTS} == {("F106", f"{changed} has changed")}


def test_no_result_is_accepted_where_one_is_missing(folder):
    (folder / "part-report.json").unlink()
    (folder / "part.pkmt").write_bytes(b"")
    assert refusal(folder / "part.pmc") == ("F106", "part-report.json is missing, part.pkmt has changed")


def test_a_folder_in_place_of_a_result_is_refused(folder):
    (folder / "part.pkmt").unlink()
    (folder / "part.pkmt").mkdir()
    assert refusal(folder / "part.pmc") == ("F106", "part.pkmt cannot be read (Is a directory)")


@pytest.mark.parametrize("name", ["part-part3.pmc", "part2.pmc", "other.pmc"])
def test_a_file_that_no_manifest_lists_is_a_warning(folder, name):
    (folder / name).write_bytes(RESULTS["part.pmc"])
    assert refusal(folder / name)[0] == "F107"


def test_it_says_what_an_earlier_posting_made(folder):
    assert sorted(manifest.listed(folder, "part")) == sorted(RESULTS)
    assert manifest.listed(folder, "other") == ()
    (folder / "part-manifest.json").write_bytes(b"{")
    assert manifest.listed(folder, "part") == ()


def test_a_folder_that_is_missing_has_no_manifest(tmp_path):
    assert refusal(tmp_path / "gone" / "part.pmc")[0] == "F107"


def test_the_manifest_with_the_longer_stem_is_that_of_a_file(folder, tmp_path_factory):
    other = tmp_path_factory.mktemp("other")
    (other / "part-part2.pmc").write_bytes(b"CLOSE\n")
    manifest.write(other, "part-part2")
    for path in other.iterdir():
        path.replace(folder / path.name)
    assert manifest.check(folder / "part-part2.pmc")[0].path.name == "part-part2-manifest.json"
    assert refusal(folder / "part.pmc") == ("F106", "part-part2.pmc has changed")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "no JSON"),
        (b"\xff\xfe", "no JSON"),
        (b"[" * 200_000, "no JSON"),
        (b" " * (1 << 24) + b"{}", "more than 16777216 bytes"),
        (b"[]", "not of format 1"),
        (b'{"format": 2, "files": {}}', "not of format 1"),
        (b'{"format": 1}', "not names with fingerprints"),
        (b'{"format": 1, "files": {"part.pmc": 1}}', "not names with fingerprints"),
        (b'{"format": 1, "files": {"part.pmc": "0"}}', "not names with fingerprints"),
        (b'{"format": 1, "files": {"../part.pmc": "%s"}}' % (b"0" * 64), "not names with fingerprints"),
    ],
    ids=range(10),  # the name of a test with 16 million bytes takes minutes to pass on
)
def test_a_damaged_manifest_is_reported(folder, content, words):
    (folder / "part-manifest.json").write_bytes(content)
    code, found = refusal(folder / "part.pmc")
    assert code == "F108" and words in found


def test_a_text_is_the_same_with_other_line_ends(folder):
    text = RESULTS["part.pmc"]
    (folder / "part.pmc").write_bytes(text.replace(b"\n", b"\r\n"))
    assert manifest.check(folder / "part.pmc")[0]
    (folder / "part.pmc").write_bytes(text.replace(b"\n", b"\r"))
    assert refusal(folder / "part.pmc") == ("F106", "part.pmc has changed")


def test_bytes_that_are_no_text_are_not_taken_for_line_ends(folder):
    (folder / "part.pkmt").write_bytes(RESULTS["part.pkmt"].replace(b"\n", b"\r\n"))
    assert refusal(folder / "part.pmc") == ("F106", "part.pkmt has changed")


@pytest.mark.parametrize("at_once", range(1, 9))
def test_line_ends_count_wherever_a_part_ends(monkeypatch, at_once):
    monkeypatch.setattr(manifest, "_AT_ONCE", at_once)
    assert manifest.fingerprint("a.pmc", b"a\r\r\nb\r\nc\r") == hashlib.sha256(b"a\r\nb\nc\r").hexdigest()
