# SPDX-License-Identifier: LGPL-2.1-or-later
"""The bytes of a program mean the same to whoever reads it."""

import pytest
from controller_settings import settings_for

from pkm_post.control.link.program import read_job
from pkm_post.writing.controllers import pmac, read_text, read_texts, text_of

SETTINGS = settings_for()
ALLOWED = {*range(0x20, 0x7F), 0x0A}


@pytest.fixture
def text(job):
    return pmac.program_text(job, SETTINGS, ["heading"])


@pytest.mark.slow
@pytest.mark.parametrize("byte", sorted(set(range(256)) - ALLOWED))
@pytest.mark.parametrize("line", [1, 12])
def test_a_character_that_does_not_belong_is_named_with_its_place(text, byte, line):
    lines = text.encode("ascii").split(b"\n")
    lines[line - 1] = lines[line - 1][:3] + bytes([byte]) + lines[line - 1][3:]
    read, faults = text_of(b"\n".join(lines), "job.pmc")
    assert read is None
    assert [(fault.code, fault.place.line, fault.place.column) for fault in faults] == [("C108", line, 4)]
    assert f"0x{byte:02X}" in faults[0].found


def test_both_kinds_of_line_end_are_read_alike(text):
    assert text_of(text.encode("ascii"), "job.pmc") == (text, ())
    assert text_of(text.replace("\n", "\r\n").encode("ascii"), "job.pmc") == (text, ())


@pytest.mark.parametrize("content", [b"CLOSE\rABS\n", b"CLOSE\r\r\n", b"CLOSE\r"])
def test_a_carriage_return_alone_is_no_line_end(content):
    assert [fault.code for fault in text_of(content, "job.pmc")[1]] == ["C108"]


def test_of_many_characters_the_first_are_reported():
    assert len(text_of(b"X" * 600 + bytes(1000), "job.pmc")[1]) == 20


@pytest.mark.parametrize(
    "content", [bytes(1000), (b"PKMT\r\n\x1a\n" + bytes(100)), "ABS\nLINEAR\nX1\nX2\nX3\n".encode("utf-16")]
)
def test_a_file_of_another_kind_is_one_fault(content):
    read, faults = text_of(content, "job.pkmt")
    assert read is None
    assert [(fault.code, fault.place.line) for fault in faults] == [("C108", 0)]


def test_a_file_that_is_not_there_is_reported(tmp_path):
    assert [fault.code for fault in read_text(tmp_path / "no.pmc")[1]] == ["F103"]


def test_each_part_is_read_so(tmp_path):
    first = tmp_path / "job.pmc"
    first.write_bytes(b"; part 1 of 2: the first\r\n")
    (tmp_path / "job-part2.pmc").write_bytes(b"; part 2 of 2:\x0b\n")
    assert [(fault.code, fault.place.file) for fault in read_texts(first, pmac)[1]] == [("C108", "job-part2.pmc")]
    (tmp_path / "job-part2.pmc").write_bytes(b"; part 2 of 2:\r\n")
    read, faults = read_texts(first, pmac)
    assert not faults
    assert read == [("job.pmc", "; part 1 of 2: the first\n"), ("job-part2.pmc", "; part 2 of 2:\n")]


def test_a_vertical_tab_in_the_heading_is_no_program(text):
    read, faults = read_job(text.replace("heading", "head\x0bing"), SETTINGS, "job.pmc")
    assert read is None and [fault.code for fault in faults] == ["C101"]
