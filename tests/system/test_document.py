# SPDX-License-Identifier: LGPL-2.1-or-later
"""A truncated, modified or foreign document is detected before FreeCAD opens it."""

import random
import struct
import zipfile
import zlib

import pytest

from pkm_post.system import DamagedDocument, read_document

OBJECTS = """<Object name="Job"><Properties>
<Property name="Label"><String value="Front &amp; back"/></Property>
<Property name="Operations"><Link value="Operations"/></Property>
<Property name="Path"><Path file="Job.nc" version="2"/></Property>
<Property name="Proxy"><Python value="bnVsbA==" encoded="yes" module="Path.Main.Job" class="ObjectJob"/></Property>
</Properties></Object>
<Object name="Operations"><Properties><Property name="Group"><LinkList count="2"><Link value="Cut"/><Link value="Bore"/>
</LinkList></Property></Properties></Object>
<Object name="Cut"><Properties><Property name="Path"><Path file="Cut.nc" version="2"/></Property></Properties></Object>
<Object name="Bore"><Properties><Property name="Path"><Path file="Bore.nc" version="2"/></Property>
</Properties></Object>
"""
NAMES = ("Job", "Operations", "Cut", "Bore")
LISTED = "".join(f'<Object type="Path::FeaturePython" name="{name}"/>' for name in NAMES)
XML = f'<?xml version="1.0" encoding="utf-8"?><Document SchemaVersion="4"><Objects Count="4">{LISTED}</Objects>' + (
    f'<ObjectData Count="4">{OBJECTS}</ObjectData></Document>'
)
MEMBERS = {
    "Document.xml": XML.encode(),
    "Job.nc": b"",
    "Cut.nc": b"(Cut)\nG0 X1.5 Y2.5 Z10\nG1 Z0 F5\nG0 Z10\n" * 9,
    "Bore.nc": b"(Bore)\nG0 X3 Y4 Z10\n",
}


def written(path, members=MEMBERS, method=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", method) as archive:
        archive.comment = b"FreeCAD Document"
        for name, content in members.items():
            archive.writestr(name, content)
    return path


@pytest.fixture
def file(tmp_path):
    return written(tmp_path / "part.FCStd")


def damage(file, content):
    """Code and words of what is found in these bytes."""
    file.write_bytes(content)
    with pytest.raises(DamagedDocument) as damaged:
        read_document(file)
    return damaged.value.code, damaged.value.found


def with_xml(file, old, new):
    """What is found in the document with other XML, in an archive that is whole."""
    assert old in XML
    return damage(file, written(file, MEMBERS | {"Document.xml": XML.replace(old, new).encode()}).read_bytes())


@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
def test_what_a_document_lists(tmp_path, method):
    content = read_document(written(tmp_path / "part.FCStd", method=method))
    (job,) = content.jobs
    assert (job.name, job.label, job.operations) == ("Job", "Front & back", ("Cut", "Bore"))
    assert content.members == ("Job.nc", "Cut.nc", "Bore.nc")


def test_a_file_that_is_not_there_is_no_damage(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_document(tmp_path / "missing.FCStd")


def test_cut_off_anywhere(file):
    whole = file.read_bytes()
    for length in range(len(whole)):
        code, _ = damage(file, whole[:length])
        assert code == ("J101" if length < 4 else "J129"), length


def read_as_freecad_does(content):
    """Name and content of each member, from the first byte on, by what is in front of each; no directory, no checksum.

    Raises:
        ValueError: there is nothing to read.
    """
    members, place = {}, 0
    while content[place : place + 4] == b"PK\x03\x04":
        _, flags, method, _, _, _, packed, size, name, extra = struct.unpack_from("<5H3I2H", content, place + 4)
        begin = place + 30 + name + extra
        data = content[begin : begin + packed]
        if flags & 0b1001:
            raise ValueError("as FreeCAD does not read it")
        unpacked = zlib.decompressobj(-15).decompress(data) if method == 8 else data
        members[content[place + 30 : place + 30 + name]] = unpacked[:size]
        place = begin + packed
    return members


@pytest.mark.slow
def test_a_bit_that_flips_is_seen_or_means_nothing(file):
    """Every third bit of the file, and what a reader that goes from member to member makes of it."""
    whole = file.read_bytes()
    wanted, unseen = read_as_freecad_does(whole), 0
    for bit in range(0, 8 * len(whole), 3):
        changed = bytearray(whole)
        changed[bit // 8] ^= 1 << bit % 8
        file.write_bytes(changed)
        try:
            content = read_document(file)
        except DamagedDocument:
            continue
        unseen += 1
        assert content.jobs[0].operations == ("Cut", "Bore")
        assert read_as_freecad_does(bytes(changed)) == wanted, bit
    assert 0 < unseen < len(whole)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_bytes_by_chance_never_raise_anything_else(file, seed):
    chance, whole = random.Random(seed), file.read_bytes()
    for _ in range(100):
        changed = bytearray(whole)
        for _ in range(chance.randrange(1, 20)):
            changed[chance.randrange(len(changed))] = chance.randrange(256)
        begin, length = chance.randrange(len(changed)), chance.choice([0, 0, 1, 50])
        del changed[begin : begin + length]
        file.write_bytes(changed)
        try:
            read_document(file)
        except DamagedDocument as damaged:
            assert damaged.code in ("J101", "J129", "J130") and damaged.found


def test_no_archive(file):
    assert damage(file, b"no document " * 1100) == ("J101", "it does not begin as a ZIP archive")
    assert damage(file, b"PK\x03\x04" + random.Random(1).randbytes(13000))[0] == "J129"


def test_another_archive(file):
    other = dict(reversed(MEMBERS.items()))
    assert damage(file, written(file, other).read_bytes()) == ("J101", "its first member is Bore.nc, not Document.xml")
    assert damage(file, b"PK\x05\x06" + bytes(18))[0] == "J101"


def test_members_with_sizes_behind_them_are_read_as_empty_by_freecad(file):
    class Pipe:
        """Cannot go back to write a size in front of what it belongs to."""

        def __init__(self, stream):
            self.write, self.flush = stream.write, stream.flush

    with file.open("wb") as stream, zipfile.ZipFile(Pipe(stream), "w") as archive:
        for name, content in MEMBERS.items():
            archive.writestr(name, content)
    code, found = damage(file, file.read_bytes())
    assert code == "J129" and "Document.xml" in found


def test_something_between_members(file):
    whole = file.read_bytes()
    place = whole.index(b"PK\x03\x04", 4)
    code, found = damage(file, whole[:place] + b"?" + whole[place:])
    assert code == "J129" and found


def test_something_behind_the_archive(file):
    assert damage(file, file.read_bytes() + b"?") == ("J129", "the file does not end where the archive does")


def test_a_member_that_is_there_twice(file):
    with pytest.warns(UserWarning, match="Duplicate name"), zipfile.ZipFile(file, "a") as archive:
        archive.writestr("Cut.nc", b"(another)\n")
    assert damage(file, file.read_bytes()) == ("J129", "Cut.nc is in it twice")


def test_a_password_or_another_method(file):
    written(file, method=zipfile.ZIP_BZIP2)
    assert damage(file, file.read_bytes())[0] == "J129"
    locked = bytearray(written(file).read_bytes())
    for signature, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        locked[locked.index(signature) + offset] |= 1
    code, found = damage(file, locked)
    assert code == "J129" and "FreeCAD does not read" in found


BAD_XML = {
    "cut off": ("</ObjectData></Document>", "", "no XML"),
    "no document": ("<Document SchemaVersion", "<!-- -->not xml", "no XML"),
    "another root": ("<Document ", "<Documents ", "<Documents> instead of <Document>"),
    "an object too few": ('<Object name="Bore">', '<Other name="Bore">', "no XML"),
    "an object that is not listed": ('<Object type="Path::FeaturePython" name="Bore"/>', "", "Bore is not in the list"),
    "an object that is not there": ('<Object name="Bore">', '<Object name="Bare">', "Bore is listed and missing"),
    "another count": ('<Objects Count="4">', '<Objects Count="3">', "3 objects declared in <Objects>, 4 found"),
    "no count": ('<ObjectData Count="4">', "<ObjectData>", "no number of objects declared in <ObjectData>, 4 found"),
    "a missing operation": (
        '<Link value="Bore"/>',
        '<Link value="Gone"/>',
        "Gone of Front & back is missing",
    ),
    "a path that is not there": ('file="Bore.nc"', 'file="Gone.nc"', "Gone.nc is listed and missing in the archive"),
    "an encoding that is none": ('encoding="utf-8"', 'encoding="utf-9"', "no XML: unknown encoding"),
    "entities": ("<Document ", '<!DOCTYPE x [<!ENTITY a "b">]><Document ', "a DOCTYPE, which FreeCAD never writes"),
}


@pytest.mark.parametrize(("old", "new", "found"), BAD_XML.values(), ids=BAD_XML)
def test_content_that_contradicts_itself(file, old, new, found):
    code, reported = with_xml(file, old, new)
    assert code == "J130"
    assert found in reported


def test_names_are_utf8_without_the_flag_for_it_as_freecad_writes_them(tmp_path):
    """In FreeCAD 1.1 the names of objects may be Chinese, and with them those of the members."""
    xml = XML.replace('file="Bore.nc"', 'file="立铣刀.nc"').encode()
    members = {"Document.xml": xml, **{name: MEMBERS[name] for name in ("Job.nc", "Cut.nc")}, "123456789.nc": b""}
    file = written(tmp_path / "part.FCStd", members)
    file.write_bytes(file.read_bytes().replace(b"123456789.nc", "立铣刀.nc".encode()))
    assert read_document(file).members[-1] == "立铣刀.nc"


def test_names_in_another_encoding_are_damage(tmp_path):
    file = written(tmp_path / "part.FCStd", MEMBERS | {"123456.nc": b""})
    code, reported = damage(file, file.read_bytes().replace(b"123456.nc", "立铣刀.nc".encode("gb18030")))
    assert code == "J129"
    assert "utf-8" in reported


SMALL = {
    "blanks": b" " * 12_000_000,
    "no markup": b"not xml " * 1_000_000,
    "one long name": b"<a " * 4_000_000,
    "text in another root": b"<x>" + b"y" * 12_000_000 + b"</x>",
    "nested": b"<Document>" + b"<a>" * 4_000_000,
    "entities of entities": b'<!DOCTYPE l [<!ENTITY a0 "lol">'
    + b"".join(b'<!ENTITY a%d "%s">' % (n + 1, b"&a%d;" % n * 10) for n in range(9))
    + b"]><Document>&a9;</Document>",
}


@pytest.mark.slow
@pytest.mark.parametrize("content", SMALL.values(), ids=SMALL)
def test_a_small_file_is_refused_after_little_of_it(file, content):
    """What unpacks to much, or names itself again and again, costs no more than its bytes."""
    packed = written(file, {"Document.xml": content})
    assert packed.stat().st_size < 14_000
    assert damage(file, packed.read_bytes())[0] == "J130"
