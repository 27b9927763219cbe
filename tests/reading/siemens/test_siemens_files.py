# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files in Siemens's language: recognised by name and content, with the evidence, and posted."""

import pytest

from pkm_post.reading.part_program import ReadingOptions, read_content
from pkm_post.reading.siemens import siemens_evidence

END = "M30\n"
RECOGNISED = {
    ("part.nc", 'MSG("A")\nCYCLE81(1)\n'): 'flavour siemens, by MSG("") in line 1, CYCLE in line 2',
    ("part.nc", "G0 X=IC(5)\nTRAORI\nORIWKS\n"): "flavour siemens, by =IC() in line 1, names such as ORIWKS in line 3",
    ("part.nc", "G0 X=IC(5)\n"): None,
    ("part.mpf", "G0 X1 Y1 Z1\n"): "flavour siemens, by the suffix .mpf",
    ("part.SPF", "R1=5\n"): "flavour siemens, by R parameters in line 1, the suffix .SPF",
    ("part.mpf", "G0 X1\nG43 H1 Z2\n"): None,
    ("part.mpf", "(A COMMENT)\nG0 X1\n"): None,
    ("part.mpf", "; G43 in a comment\nG0 X1\n"): "flavour siemens, by the suffix .mpf",
    ("part.mpf", 'T="A"\nCR=1\nG28 Z0\n'): 'flavour siemens, by T="" in line 1, CR= in line 2, the suffix .mpf',
    ("part.nc", "O1001\nG0 G28 Z0\n"): None,
}  # fmt: skip


@pytest.mark.parametrize(("file", "text"), RECOGNISED)
def test_the_language_is_recognised_by_its_evidence(file, text):
    assert siemens_evidence(text.encode(), file) == RECOGNISED[file, text]


BLOCKS = "G90 G54 G71 F600\nG0 X0 Y0 Z10\nG1 X5\n"


def test_the_reader_is_chosen_by_flavour_or_evidence():
    for name, flavour, line in (
        ("part.mpf", None, "flavour siemens, by the suffix .mpf"),
        ("part.nc", "siemens", "flavour siemens, as chosen"),
        ("part.mpf", "fanuc", "flavour fanuc, as chosen"),
    ):
        program, _ = read_content((BLOCKS + END).encode(), name, ReadingOptions(flavour=flavour))
        assert program.reading[0] == line
    program, _ = read_content((BLOCKS.replace("G71", "G21") + END).encode(), "part.nc", ReadingOptions())
    assert program.reading[0].startswith("flavour rs274")


def test_a_heading_cancels_compensation_of_a_cutter_whose_diameter_is_unknown():
    text = f'G17 G40 G90 G71\nT="MILL"\nM6\nS100 M3\nG54 F600\nG0 X0 Y0 Z10\nG1 X5\nM5\n{END}'
    program, _ = read_content(text.encode(), "part.mpf", ReadingOptions())
    assert program.side_offset.tolist() == [0.0, 0.0]
    refused, diagnostics = read_content(text.replace("G1 X5", "G41 G1 X5").encode(), "part.mpf", ReadingOptions())
    assert refused is None
    assert [found.code for found in diagnostics] == ["G411"]


def test_options_name_a_tool_by_the_number_that_its_name_was_given():
    text = f'G17 G90 G71\nT="MILL"\nM6\nT="BALL"\nM6\nS100 M3\nG54 F600\nG0 X0 Y0 Z10\nM5\n{END}'
    reading = ReadingOptions(lengths={1: 100.0, 2: 120.0})
    program, _ = read_content(text.encode(), "part.mpf", reading)
    assert {(tool.number, tool.name, tool.length) for tool in program.tools.values()} >= {(2, "BALL", 120.0)}


def test_a_superscript_in_the_name_of_a_tool_is_no_digit():
    text = f'G17 G90 G71\nT="\u00b2"\nM6\nG54 F600\nG0 X0 Y0 Z10\nG1 X5\n{END}'
    program, _ = read_content(text.encode("latin-1"), "part.mpf", ReadingOptions())
    assert [(tool.number, tool.name) for tool in program.tools.values()] == [(1, "\u00b2")]
