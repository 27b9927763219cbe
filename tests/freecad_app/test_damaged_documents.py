# SPDX-License-Identifier: LGPL-2.1-or-later
"""A document that was cut off, changed, or not read by FreeCAD as it was saved is refused at every door, by name."""

import random
import types
import zipfile

import FreeCAD as App
import pytest
from cam_jobs import add_operation, job_in_reach
from Path.Post.Processor import PostProcessorFactory

from pkm_post.cli import main
from pkm_post.freecad_app import document_checks as document_damage
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.job_setup import prepared_job
from pkm_post.freecad_app.post_job import find_job, post_document, post_job
from pkm_post.model import Refused

CUT = ["G0 X0 Y0 Z30", "G0 Z26", "G1 X2 Y1 Z25 F25", "G0 Z30"]
OPERATIONS = ("Custom", "Custom001", "Custom002", "Custom003")
TRUNCATIONS, FLIPS = 60, 300
REFUSED = {"J101", "J129", "J130"}


@pytest.fixture(scope="module")
def intact(tmp_path_factory):
    """The bytes of a document with four operations."""
    document = App.newDocument("part")
    job = job_in_reach(document)
    for number in range(4):
        add_operation(job, [*CUT, f"G1 X{number} F25"], f"Cut {number}")
    path = tmp_path_factory.mktemp("read_content") / "part.FCStd"
    document.saveAs(str(path))
    App.closeDocument(document.Name)
    return path.read_bytes()


@pytest.fixture
def part(tmp_path, intact):
    path = tmp_path / "part.FCStd"
    path.write_bytes(intact)
    yield path
    for name in App.listDocuments():
        App.closeDocument(name)


def members(path):
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def with_member(path, name, content):
    """The same document with another member, in an archive that is whole."""
    whole = members(path) | {name: content}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, data in whole.items():
            archive.writestr(each, data)


def with_xml(path, old, new):
    content = members(path)["Document.xml"].decode()
    assert old in content
    with_member(path, "Document.xml", content.replace(old, new).encode())


def results(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def refusal(call, *arguments):
    with pytest.raises(Refused) as refused:
        call(*arguments)
    return [(fault.code, fault.place.operation) for fault in refused.value.diagnostics]


def posting(path):
    """What posting a document is refused for; nothing is written."""
    out = path.with_name("out")
    faults = refusal(post_document, path, None, out)
    assert not out.exists() and App.listDocuments() == {}
    return faults


def posted(path, name="out"):
    post_document(path, out=path.with_name(name))
    return results(path.with_name(name))


def test_cut_off_at_every_member_and_anywhere(part, intact, capsys):
    with zipfile.ZipFile(part) as archive:
        ends = [member.header_offset for member in archive.infolist()] + [archive.start_dir]
    chance = random.Random(1)
    for length in [*ends, *(chance.randrange(len(intact)) for _ in range(TRUNCATIONS))]:
        part.write_bytes(intact[:length])
        assert main(["post", str(part), "--out", str(part.with_name("out"))]) == 1, length
        reported = capsys.readouterr().err
        assert "error J129" in reported or "error J101" in reported, length
        assert "Traceback" not in reported
    assert not part.with_name("out").exists()


def test_a_bit_that_flips_is_refused_or_changes_nothing(part, intact):
    wanted, chance, unseen = posted(part), random.Random(2), 0
    for bit in chance.sample(range(8 * len(intact)), FLIPS):
        changed = bytearray(intact)
        changed[bit // 8] ^= 1 << bit % 8
        part.write_bytes(changed)
        try:
            document_damage.read_content(part)
        except Refused as refused:
            assert {fault.code for fault in refused.diagnostics} <= REFUSED
            continue
        unseen += 1
        assert posted(part, f"out{bit}") == wanted, bit
    assert 0 < unseen < FLIPS / 4


def test_a_tool_bit_with_a_chinese_name_is_posted(part):
    """FreeCAD 1.1 names the members of the archive by it, in UTF-8 and without the flag that says so."""
    document = App.openDocument(str(part))
    document.addObject("Part::Box", "立铣刀")
    document.recompute()
    document.save()
    App.closeDocument(document.Name)
    assert posted(part)


SMALL = {
    "no archive": b"not xml " * 1600,
    "no XML": b" " * 12_000_000,
    "entities of entities": b'<?xml version="1.0"?><!DOCTYPE l [<!ENTITY a0 "lol">'
    + b"".join(b'<!ENTITY a%d "%s">' % (n + 1, b"&a%d;" % n * 10) for n in range(9))
    + b']><Document SchemaVersion="4">&a9;</Document>',
}


@pytest.mark.parametrize("content", SMALL.values(), ids=SMALL)
def test_freecad_never_sees_what_would_keep_it_for_minutes(tmp_path, monkeypatch, content):
    monkeypatch.delattr(App, "openDocument")
    path = tmp_path / "part.FCStd"
    path.write_bytes(content)
    assert posting(path) == [("J101", "")]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("Document.xml", content)
    assert posting(path) == [("J130", "")]


def test_the_report_says_how_many_operations_there_were(part):
    (one,) = post_document(part, out=part.parent)
    assert one.report["program"]["reading"] == ["operations of the job: 4 listed, 4 meant and active, 4 read"]
    document = App.openDocument(str(part))
    document.getObject("Custom001").Active = False
    job = find_job(document)
    one = post_job(job, out=part.parent)
    assert one.report["program"]["reading"] == ["operations of the job: 4 listed, 3 meant and active, 3 read"]
    assert one.report["program"]["operations"] == ["Cut 0", "Cut 2", "Cut 3"]


def test_an_operation_that_freecad_did_not_make(part):
    with_xml(part, '"Path::FeaturePython" name="Custom001"', '"Path::NotKnown" name="Custom001"')
    assert posting(part) == [("J131", "")]


def test_a_path_that_freecad_cannot_read(part):
    with_member(part, "Custom001.nc", b"\x00\xff garbage $$ G1 X1..2")
    assert posting(part) == [("J134", "Cut 1")]


def test_a_path_that_is_empty_until_it_is_computed(part, tmp_path):
    with_member(part, "Custom001.nc", b"")
    assert posting(part) == [("J132", "Cut 1")]
    document = App.openDocument(str(part))
    document.getObject("Custom001").touch()  # Mark to Recompute
    document.recompute()
    document.save()
    App.closeDocument(document.Name)
    assert "Custom001" in OPERATIONS and posted(part)["part.pmc"]


def test_an_empty_path_of_an_inactive_operation_is_none_of_ours(part):
    document = App.openDocument(str(part))
    document.getObject("Custom001").Active = False
    document.recompute()
    document.save()
    App.closeDocument(document.Name)
    with_member(part, "Custom001.nc", b"")
    assert posted(part)["part.pmc"]


def test_a_path_with_bytes_that_are_no_text(part):
    with_member(part, "Custom001.nc", b"(caf\xe9)\nG0 X0 Y0 Z10\n")
    assert posting(part) == [("J135", "Cut 1")]


def test_something_that_is_no_operation(part):
    document = App.openDocument(str(part))
    stranger = document.addObject("App::FeaturePython", "Note")
    operations = find_job(document).Operations
    operations.Group = [*operations.Group, stranger]
    document.recompute()
    assert [(fault.code, fault.place.operation) for fault in read_job(find_job(document))[1]] == [("J136", "Note")]


def test_a_document_that_is_not_recomputed(part):
    document = App.openDocument(str(part))
    job, operation = find_job(document), document.getObject("Custom001")
    document.RecomputesFrozen = True  # Skip Recomputes
    operation.Gcode = [*CUT, "G1 X9 F25"]
    assert refusal(post_job, job, None, part.parent) == [("J133", "Cut 1")]
    document.RecomputesFrozen = False
    assert post_job(job, out=part.parent).program.is_file()


def by_cam(job):
    job.PostProcessorOutputFile = str(job.Document.FileName).replace("part.FCStd", "part.pmc")
    PostProcessorFactory.get_post_processor(job, "hexapod_pmac").export()


def by_cam_as_gcode(job):
    PostProcessorFactory.get_post_processor(job, "hexapod_gcode").export()


def by_panel(job):
    return prepared_job(job, settings_of(job)).sound


def by_macro(job):
    post_job(job, out=job.Document.FileName.replace("part.FCStd", "out"))


@pytest.mark.parametrize("door", [by_cam, by_cam_as_gcode, by_panel, by_macro])
def test_a_document_that_was_opened_from_a_damaged_file(part, intact, door):
    """FreeCAD opens it, and shows a job of two operations with paths."""
    with zipfile.ZipFile(part) as archive:
        end = archive.getinfo("Custom002.nc").header_offset
    part.write_bytes(intact[:end])
    document = App.openDocument(str(part))
    job = find_job(document)
    assert [len(each.Path.Commands) > 0 for each in job.Operations.Group][:2] == [True, True]
    codes = [code for code, _ in refusal(door, job)]
    assert codes[0] == "J129"
    assert {path.name for path in part.parent.iterdir()} == {"part.FCStd"}


def test_a_file_is_read_once_for_each_of_its_states(part, intact, monkeypatch):
    read, of = [], document_damage.read_document
    monkeypatch.setattr(document_damage, "read_document", lambda file: read.append(file) or of(file))
    document = App.openDocument(str(part))
    job = find_job(document)
    assert [read_job(job)[1] for _ in range(3)] == [()] * 3
    assert len(read) == 1
    document.save()
    assert read_job(job)[1] == ()
    assert len(read) == 2
    part.unlink()
    assert read_job(job)[1] == ()


@pytest.mark.parametrize(
    ("status", "found"), [("Error", "the document does not store why"), ("N111: off the face", "N111: off the face")]
)
def test_an_error_from_the_file_has_no_reason_in_freecad(status, found):
    """The file stores that an object has an error, and its status is then the word alone [App::DocumentObject]."""
    operation = types.SimpleNamespace(isValid=lambda: False, getStatusString=lambda: status)
    assert document_damage._not_valid(operation) == found
