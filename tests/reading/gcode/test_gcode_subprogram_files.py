# SPDX-License-Identifier: LGPL-2.1-or-later
"""Subprograms in other files: which file a call finds, what it does there, and where its faults are."""

import pytest

from pkm_post.reading import AS_WRITTEN, ReadingOptions, check_file, check_text, checks_as_text, read_part_program
from pkm_post.reading.gcode import ExecutionLimits, ReadOptions, read

HEAD = "G21 G90\nG0 X0. Y0. Z5.\nG1 F100.\n"
MAIN = f"O1\n{HEAD}M98 P1234\nX9.\nM30\n"
SUB = "O1234\nX1.\nX2.\nM99\n"


def written(folder, **files):
    """Files of these names, with a point for each underscore."""
    folder.mkdir(exist_ok=True)
    for name, text in files.items():
        (folder / name.replace("_", ".")).write_text(text, encoding="utf-8")
    return folder


def taken(file, *folders):
    return read_part_program(file, ReadingOptions(flavour="fanuc", subprograms=tuple(map(str, folders))))


def way(program):
    return program.position[1:, 0].tolist()


@pytest.mark.parametrize("name", ["O1234_nc", "o1234", "1234_tap", "O01234_NC", "O1234_TXT"])
@pytest.mark.parametrize("sub", [SUB, "%\n" + SUB + "%\nX7.\n", SUB.removeprefix("O1234\n"), ":1234\nX1.\nX2.\nM99"])
def test_a_call_finds_the_file_of_its_number(tmp_path, name, sub):
    written(tmp_path, main_nc=MAIN, **{name: sub})
    program, _ = taken(tmp_path / "main.nc")
    assert way(program) == [1.0, 2.0, 9.0]
    inside = f"subprogram {name.replace('_', '.')}"
    assert [program.operations[number] for number in program.operation.tolist()] == ["", inside, inside, ""]
    first = 1 + sub.removeprefix("%\n").startswith(("O", ":")) + sub.startswith("%")
    assert program.line.tolist() == [3, first, first + 1, 6]
    assert sum("SHA-256" in line for line in program.reading) == 1


@pytest.mark.parametrize(("flavour", "call"), [("fanuc", "M98 P1234"), ("siemens", "L1234")])
def test_a_subprogram_in_another_encoding_is_refused_by_its_name(tmp_path, flavour, call):
    written(tmp_path, main_nc=f"{HEAD}{call}\nM30\n")
    file = tmp_path / ("L1234.SPF" if flavour == "siemens" else "O1234.nc")
    file.write_bytes(SUB.encode("utf-16"))
    program, faults = read_part_program(tmp_path / "main.nc", ReadingOptions(flavour=flavour))
    assert program is None
    assert [(each.code, each.place.file, each.found) for each in faults] == [("F121", str(file), "UTF-16")]


def test_a_superscript_in_the_name_of_a_subprogram_is_no_digit(tmp_path):
    (tmp_path / "main.ngc").write_bytes(f"{HEAD}o<\u00b2> call\nM2\n".encode("latin-1"))
    program, faults = read_part_program(tmp_path / "main.ngc", AS_WRITTEN)
    assert program is None
    assert [(each.code, each.place.line, each.found) for each in faults] == [("G309", 4, "O<\u00b2> call")]


def test_linuxcnc_calls_by_name_and_number_with_arguments(tmp_path):
    main = f"{HEAD}o<My Hole> call [3]\no100 call [4]\n#1=100\no#1 call [5]\nM2\n"
    written(
        tmp_path,
        main_ngc=main,
        myhole_ngc="o<myhole> sub\nG1 X#1\no<myhole> endsub\nM2\n",
        **{"100_ngc": "o100 sub\nG1 X[#1*2]\no100 endsub\n"},
    )
    program, _ = read_part_program(tmp_path / "main.ngc", AS_WRITTEN)
    assert way(program) == [3.0, 8.0, 10.0]


def test_files_call_files_and_a_file_is_read_once(tmp_path):
    written(
        tmp_path,
        main_nc=f"O1\n{HEAD}M98 P20002\nM98 P3\nM30\n",
        O0002_nc="O2\nG91 X1. F50.\nG90\nM98 P3\nM99\nO77\nM99\n",
        O3_nc="G91 Y1.\nG90\nM99\n",
    )
    program, _ = taken(tmp_path / "main.nc")
    assert program.position[-1].tolist() == [2.0, 3.0, 5.0]
    assert len(program.operations) == 3


def test_folders_are_searched_in_order_and_that_of_the_program_last(tmp_path):
    shop = written(tmp_path / "shop", O1234_nc="O1234\nX5.\nM99\n")
    library = written(tmp_path / "library", O1234_nc="O1234\nX6.\nM99\n")
    written(tmp_path, main_nc=MAIN, O1234_nc=SUB)
    empty = written(tmp_path / "empty")
    for folders, first in (((shop, library), 5.0), ((library, shop), 6.0), ((), 1.0), ((empty,), 1.0)):
        assert way(taken(tmp_path / "main.nc", *folders)[0])[0] == first


def test_no_file_elsewhere_stands_in_for_a_folder_that_is_not_there(tmp_path):
    shop = written(tmp_path / "shop", O1234_nc="O1234\nX5.\nM99\n")
    written(tmp_path, main_nc=MAIN, O1234_nc=SUB, main_mpf="G0 X0 Y0 Z5\nG1 F100 X1\nM30\n")
    for missing in (tmp_path / "shpo", tmp_path / "main.nc"):
        for name in ("main.nc", "main.mpf"):
            options = ReadingOptions(subprograms=(str(shop), str(missing)))
            program, found = read_part_program(tmp_path / name, options)
            assert program is None
            assert [(each.code, each.place.file) for each in found] == [("F103", str(missing))]


def faults(folder, **options):
    _, found = read_part_program(folder / "main.nc", ReadingOptions(flavour="fanuc", **options))
    return [(each.code, each.place.file.rpartition("/")[2], each.place.line, each.place.column) for each in found]


@pytest.mark.parametrize(
    ("files", "expected"),
    [
        ({}, [("G309", "main.nc", 5, 0)]),
        ({"O1234_nc": SUB, "1234_tap": SUB}, [("G318", "main.nc", 5, 0)]),
        ({"O1234_nc": "O4321\nM99\n"}, [("G309", "main.nc", 5, 0)]),
        ({"O1234_nc": "O1234\nX1.\nX[1\nM99\n"}, [("G205", "O1234.nc", 3, 2)]),
        ({"O1234_nc": "O1234\nX1.\nG77\nM99\n"}, [("G401", "O1234.nc", 3, 1)]),
        ({"O1234_nc": "O1234\nX1. Y#177\n#1=1/0\nM99\n"}, [("G304", "O1234.nc", 3, 5)]),
        ({"O1234_nc": "O1234\nX1.\n"}, [("G308", "O1234.nc", 1, 0)]),
        ({"O1234_nc": "O1234\nM98 P1234\nM99\n"}, [("G314", "O1234.nc", 2, 0)]),
    ],
    ids=["none", "two", "another number", "syntax", "meaning", "execution", "no end", "endless"],
)
def test_faults_are_placed_in_their_file(tmp_path, files, expected):
    written(tmp_path, main_nc=MAIN, **files)
    assert [each for each in faults(tmp_path) if each[0] != "G214"] == expected


def test_warnings_of_a_file_are_kept(tmp_path):
    written(tmp_path, main_nc=MAIN, O1234_nc=f"%\n{SUB}%\nX7.\n")
    assert faults(tmp_path) == [("G212", "O1234.nc", 7, 1)]


def test_a_source_line_is_that_of_its_file(tmp_path):
    written(tmp_path, main_nc=MAIN, O1234_nc="O1234\nX1.\nG77\nM99\n")
    shown = checks_as_text([check_file(tmp_path / "main.nc")]).splitlines()
    assert shown[1] == "    G77"


def test_the_editor_underlines_nothing_for_a_fault_of_another_file(tmp_path):
    written(tmp_path, O1234_nc="O1234\nX1.\nG77\nM99\n")
    checked = check_text(MAIN, str(tmp_path / "main.nc"))
    assert [(each.place.line, each.place.operation) for each in checked.diagnostics] == [(0, "O1234.nc: line 3:1")]


def test_the_number_of_files_is_bounded(tmp_path):
    calls = "".join(f"M98 P{number}\n" for number in range(2, 6))
    written(tmp_path, **{f"O{number}_nc": "X1.\nM99\n" for number in range(2, 6)})
    options = ReadOptions(flavour="fanuc", folders=(tmp_path,))
    text = f"O1\n{HEAD}{calls}M30\n"
    assert read(text, "main.nc", options, ExecutionLimits(files=4))[0] is not None
    _, found = read(text, "main.nc", options, ExecutionLimits(files=3))
    assert [(each.code, each.place.line) for each in found] == [("G309", 8)]


def test_nothing_runs_into_a_file(tmp_path):
    """A main program that ends with a percent sign ends there, and not in what was added behind it."""
    written(tmp_path, main_ngc=f"%\n{HEAD}o<hole> call\n%\n", hole_ngc="X8.\no<hole> sub\nX1.\no<hole> endsub\nX7.\n")
    program, _ = read_part_program(tmp_path / "main.ngc", AS_WRITTEN)
    assert way(program) == [1.0]
