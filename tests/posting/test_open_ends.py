# SPDX-License-Identifier: LGPL-2.1-or-later
"""Part programs that were cut short are refused, wherever the cut is."""

import random
import re

import pytest

from pkm_post.model import Refused
from pkm_post.model.diagnostics import errors
from pkm_post.posting.post_file import post_file
from pkm_post.reading.check import check_file
from pkm_post.reading.editing import check_text
from pkm_post.reading.part_program import AS_WRITTEN, ReadingOptions, read_content
from pkm_post.writing.gcode import GcodeDialect, write

MILLED = b"""%
O100 (BRACKET)
N10 G21 G90 G17 T1 M6
N20 S9000 M3
N30 G0 X0. Y0. Z20.
N40 G1 Z-1.5 F120.
N50 X30. M8
N60 G3 X40. Y10. I0. J10.
N70 G0 Z20.
N80 M5
N90 M30 (END)
%
; posted by a CAM system
"""
DEMARCATED = b"%\nG0 X0 Y0 Z20\nM3 S800\nG1 Z-1 F100\nX25\nG0 Z20\nM5\n% (end)\n\n"
COMPUTED = b"""#1=3 (depth)
o10 sub
G1 Z[0-#1] F200
X20
G0 Z30
o10 endsub
G0 X0 Y0 Z30
o10 call
o11 while [#1 lt 5]
#1=[#1+1]
o10 call
o11 endwhile
M3 S100
/M2
"""
OF_SUBPROGRAMS = (
    b"O1\r\nG0 X0 Y0 Z9\r\nM98 P7 L2\r\nG91\r\nM98 P7\r\nM30\r\nO7\r\nG1 X5 Z-2 F100\r\nG0 Z9\r\nM99\r\n%\r\n"
)
CREO = b"""$$*  Pro/CLfile Version 8.0
UNITS / MM
LOADTL / 1
SPINDL / RPM, 3000, CLW
RAPID
GOTO / 0, 0, 20
FEDRAT / 200, MMPM
GOTO / 0, 0, -1
CIRCLE / 10, 0, -1, $
0, 0, 1, 10
GOTO / 20, 0, -1
RAPID
GOTO / 20, 0, 20
SPINDL / OFF
$$-> END /
FINI
"""
NX = b"""TOOL PATH/CAVITY,TOOL,MILL
TLDATA/MILL,10.0,0.0,75.0,0.0,0.0
MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0
$$ centerline data
PAINT/PATH
SPINDL/RPM,1000.0,CLW
RAPID
GOTO/0.0,0.0,20.0,0.0,0.0,1.0
FEDRAT/MMPM,250.0
GOTO/0.0,0.0,-2.0
GOTO/30.0,0.0,-2.0
RAPID
GOTO/30.0,0.0,20.0
PAINT/SPEED,10
END-OF-PATH
"""
MAKINO = b"""PPRINT/APTCL-SPEC,MAKINO
PPRINT/BEGIN-SECTION,MACHINING
UNITS/MM
RAPID
GOTO/0,0,20,0,0,1
FEDRAT/250,MMPM
GOTO/0,0,-2
RAPID
GOTO/0,0,20
PPRINT/END-SECTION,MACHINING
PPRINT/BEGIN-SECTION,PROCESS-END-PATH
PPRINT/END-SECTION,PROCESS-END-PATH
"""
PROGRAMS = {
    "milled.nc": MILLED,
    "demarcated.ngc": DEMARCATED,
    "computed.ngc": COMPUTED,
    "of_subprograms.nc": OF_SUBPROGRAMS,
    "part.ncl": CREO,
    "part.cls": NX,
    "two_paths.cls": NX + NX.replace(b"CAVITY", b"PROFILE"),
    "plane.cldata": MAKINO,
}
WITHOUT_MEANING = re.compile(rb"\([^()\n]*\)|;[^\n]*|\$\$[^\n]*|[\s%]")


def written(program):
    """What a program is, as bytes of G-code."""
    text, reported = write(program, GcodeDialect.VECTOR)
    assert not errors(reported)
    return text


def cuts(content):
    """Behind every line, and at bytes at random."""
    chance = random.Random(2)
    lines = [end.end() for end in re.finditer(b"\n", content)]
    return sorted({*lines, *(chance.randrange(len(content)) for _ in range(60))})


@pytest.mark.slow
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_that_is_cut_is_refused_or_the_same(name):
    content = PROGRAMS[name]
    whole, reported = read_content(content, name, AS_WRITTEN)
    assert not errors(reported)
    refused = 0
    for place in cuts(content):
        program, reported = read_content(content[:place], name, AS_WRITTEN)
        if program is None:
            assert errors(reported), place
            refused += 1
        elif content[:place].rstrip().endswith(b"END-OF-PATH"):  # a tool path of NX, whole by itself
            continue
        else:
            assert WITHOUT_MEANING.sub(b"", content[:place]) == WITHOUT_MEANING.sub(b"", content), place
            assert written(program) == written(whole)
    assert refused > 10


@pytest.mark.parametrize(("name", "code"), [("part.ngc", "G430"), ("part.apt", "L441")])
@pytest.mark.parametrize("reading", [ReadingOptions(), ReadingOptions(allow_open_end=True)])
def test_the_option_takes_what_is_there(tmp_path, name, code, reading):
    text = {"part.ngc": "S80 M3\nG0 X0 Y0 Z5\nG1 X9 F100\n", "part.apt": "UNITS/MM\nSPINDL/80,CLW\nGOTO/1,2,3\n"}[name]
    file = tmp_path / name
    file.write_text(text, encoding="ascii")
    checked = check_file(file, reading)
    reported = [each.code for each in checked.diagnostics if each.code != "L411"]
    assert (reported, checked.is_clean) == ((["V130"], True) if reading.allow_open_end else ([code], False))
    assert (checked.size is not None) == reading.allow_open_end
    assert {each.place.line for each in checked.diagnostics if each.code in (code, "V130")} == {3}


def test_nothing_is_posted_of_a_program_without_an_end(tmp_path):
    file, out = tmp_path / "part.ngc", tmp_path / "out"
    file.write_text("G0 X0 Y0 Z20\nG1 Z5 F500\nX20\n", encoding="ascii")
    words = "--tool-length 0=100 --work-offset 0,0,250"
    out.mkdir()
    with pytest.raises(Refused) as refused:
        post_file(file, out=out, arguments=words)
    assert [each.code for each in errors(refused.value.diagnostics)] == ["G430"]
    assert list(out.iterdir()) == []
    with pytest.raises(Refused, match="error G430"):
        post_file(file, out=out, arguments=f"{words} --allow-open-end --no-allow-open-end")
    posted = post_file(file, out=out, arguments=f"{words} --allow-open-end")
    assert posted.program.exists()
    assert "V131" in [each.code for each in posted.diagnostics]


def test_a_text_is_drawn_before_its_end_is_written():
    checked = check_text("G0 X0 Y0 Z5\nG1 X9 F100\n", "part.ngc")
    assert [(each.code, each.place.line) for each in checked.diagnostics] == [("G430", 2)]
    assert (len(checked.program), checked.size.length) == (2, 9.0)
    assert check_text("G0 X0 Y0 Z5\nG1 X\n", "part.ngc").program is None
