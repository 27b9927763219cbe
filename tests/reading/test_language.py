# SPDX-License-Identifier: LGPL-2.1-or-later
"""The language of a part program by its name, and of a text file by its content."""

from pathlib import Path

import pytest

from pkm_post.reading import Language, is_part_program, language_of, program_stem
from pkm_post.reading.part_program import ReadingOptions, read_content, read_part_program

CL_DATA = "UNITS/MM\nLOADTL/1,LENGTH,50\nFEDRAT/100,MMPM\nRAPID\nGOTO/0,0,5\nGOTO/1,2,3\nRAPID\nGOTO/1,2,9\nFINI\n"


@pytest.mark.parametrize(
    ("name", "language", "stem"),
    [
        ("a.NGC", Language.GCODE, "a"),
        ("b.tap", Language.GCODE, "b"),
        ("c.cls", Language.CLDATA, "c"),
        ("d.aptsource", Language.CLDATA, "d"),
        ("part.ncl.1", Language.CLDATA, "part"),
        ("part.op20.NCL.12", Language.CLDATA, "part.op20"),
        ("e.as", Language.CLDATA, "e"),
        ("f.clt", Language.CLDATA, "f"),
    ],
)
def test_language_and_stem_by_name(name, language, stem):
    assert (language_of(name), program_stem(Path(name))) == (language, stem)


@pytest.mark.parametrize("name", ["e.doc", "part.prt.1", "part.ngc.1", "part.ncl.x", "part.ncl.", "1"])
def test_other_names(name):
    assert not is_part_program(Path(name))
    with pytest.raises(ValueError, match="suffix of"):
        language_of(name)


@pytest.mark.parametrize(
    "text",
    ["GOTO/1,2,3", "\n\n  units / mm", "$$ anything", "PARTNO P1", "%\nTOOL PATH/A,TOOL,B", "N10 PARTNO/A",
     "TLON,GOFWD/(CIRCLE/0,0,0,1)", "CSI_SET_FLUTE_LENGTH/1", "END-OF-PATH/"],
)  # fmt: skip
def test_text_that_is_cl_data(text):
    assert language_of("a.txt", text.encode()) is Language.CLDATA
    assert language_of("a.ngc", text.encode()) is Language.GCODE


@pytest.mark.parametrize(
    "text",
    ["", "%\nO1234\nG0 X1", "(tool / 5)\nG1", "; GOTO/1,2,3\nG1 X1", "/N10 G1", "#1=[#2/2]", "G1 X[#1/2]", "R1=R2/3",
     "BEGIN PGM X MM", "A" * 70000 + "/1"],
)  # fmt: skip
def test_text_that_is_not(text):
    assert language_of("a.txt", text.encode()) is Language.GCODE


def test_the_same_statements_mean_the_same_under_every_name(tmp_path):
    read = {name: read_content(CL_DATA.encode(), name, ReadingOptions())[0] for name in ("a.apt", "a.ncl.3", "a.txt")}
    for name, program in read.items():
        assert program.position.tolist() == [[0, 0, 5], [1, 2, 3], [1, 2, 9]], name
    (tmp_path / "a.txt").write_text(CL_DATA, encoding="ascii")
    from_file, _ = read_part_program(tmp_path / "a.txt", ReadingOptions())
    assert from_file.position.tolist() == read["a.apt"].position.tolist()


def test_a_text_file_that_does_not_exist_is_a_fault_of_the_input(tmp_path):
    program, (fault,) = read_part_program(tmp_path / "none.txt", ReadingOptions())
    assert (program, fault.code) == (None, "F103")


@pytest.mark.parametrize("suffix", ["ngc", "cls", "txt", "mpf"])
@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-32"])
def test_a_file_in_another_encoding_is_refused_by_its_name(tmp_path, suffix, encoding):
    text = CL_DATA if suffix == "cls" else "G21 G90 (\u76ee\u5f55)\nG0 X0 Y0 Z5\nG1 X9 F100\nM30\n"
    if encoding == "utf-32":
        text += "(\u9aa8)\n"
    (tmp_path / f"part.{suffix}").write_bytes(text.encode(encoding))
    program, faults = read_part_program(tmp_path / f"part.{suffix}", ReadingOptions())
    assert program is None
    assert [(each.code, each.found) for each in faults] == [("F121", encoding[:6].upper())]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1"])
def test_files_of_one_byte_a_letter_are_read(tmp_path, encoding):
    (tmp_path / "part.ngc").write_bytes("G21 G90 (\xfc)\nG0 X0 Y0 Z5\nG1 X9 F100\nM30\n".encode(encoding))
    assert len(read_part_program(tmp_path / "part.ngc", ReadingOptions())[0]) == 2
