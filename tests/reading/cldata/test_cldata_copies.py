# SPDX-License-Identifier: LGPL-2.1-or-later
"""COPY, INDEX and TRACUT: the same motion as written out by hand, and places computed by hand."""

import numpy as np
import pytest

from pkm_post.model.diagnostics import errors
from pkm_post.reading.cldata import ReadOptions, copies, read

HEAD = "UNITS/MM\nLOADTL/1,LENGTH,100\nCUTTER/10\nFEDRAT/600,MMPM\nRAPID\nGOTO/0,0,50\n"
PATH = "RAPID\nGOTO/10,0,5,0,0,1\nGOTO/10,0,0,0.6,0,0.8\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\nRAPID\nGOTO/0,10,5,0,0,1\n"
QUARTER = "MODIFY,0,-1,0,0,1,0,0,0,0,0,1,0"
NANOMETRE = 1e-6


def program(text, **options):
    found, diagnostics = read(f"{HEAD}{text}FINI\n", "part.cl", ReadOptions(dialect="creo", **options))
    assert found is not None, "\n".join(map(str, diagnostics))
    return found


def codes(text):
    found, diagnostics = read(f"{HEAD}{text}FINI\n", "part.cl", ReadOptions(dialect="creo"))
    assert found is None
    return [fault.code for fault in errors(diagnostics)]


def moved_by_hand(text, matrix):
    """The statements of a path, each point, axis and circle moved; TRACUT and COPY do not occur."""
    matrix, lines = np.array(matrix, dtype=float), []
    for line in text.splitlines():
        word, _, rest = line.partition("/")
        values = [float(item) for item in rest.split(",")] if word in ("GOTO", "CIRCLE") else []
        moved = list(matrix[:, :3] @ values[:3] + matrix[:, 3]) if values else []
        moved += list(matrix[:, :3] @ values[3:6]) if len(values) > 3 else []
        lines.append(f"{word}/" + ",".join(map(repr, map(float, [*moved, *values[6:]]))) if values else line)
    return "\n".join(lines) + "\n"


TURN = [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0]]
HALF = [[-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 1, 0]]


@pytest.mark.parametrize(
    ("copy", "matrices"),
    [
        ("SAME,2", [np.eye(4)[:3]] * 2),
        ("TRANSL,30,0,-1,2", [[[1, 0, 0, 30 * k], [0, 1, 0, 0], [0, 0, 1, -k]] for k in (1, 2)]),
        ("XYROT,90,2", [TURN, HALF]),
        ("XYROT,-90,1", [[[0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 1, 0]]]),
        ("YZROT,90,1", [[[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0]]]),
        ("ZXROT,90,1", [[[0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0]]]),
        (f"{QUARTER},2", [TURN, HALF]),
    ],
)
def test_copies_are_the_path_written_again(copy, matrices):
    found = program(f"INDEX/7\n{PATH}COPY/7,{copy}\nGOTO/0,0,60\n")
    # the axis of the last point is in force at a point without one
    last = np.array(matrices[-1])[:, 2]
    by_hand = "".join(moved_by_hand(PATH, one) for one in ([*np.eye(4)[:3]], *matrices))
    expected = program(f"{by_hand}GOTO/0,0,60,{last[0]},{last[1]},{last[2]}\n")
    assert found.kind.tolist() == expected.kind.tolist()
    for name in ("position", "tool_axis", "feed", "arc_centre", "arc_axis"):
        rows = slice(None, -1) if name == "tool_axis" else slice(None)
        np.testing.assert_allclose(getattr(found, name)[rows], getattr(expected, name)[rows], rtol=0, atol=NANOMETRE)
    points = PATH.count("GOTO")
    assert found.line[1 : points + 1].tolist() * (len(matrices) + 1) == found.line[1:-1].tolist()


def test_inches_move_copies_by_inches():
    text = "UNITS/INCHES\nFEDRAT/60,IPM\nINDEX/1\nGOTO/1,0,0\nCOPY/1,TRANSL,2,0,0,1\nFINI\n"
    found, _ = read(text, "part.cl", ReadOptions())
    assert found.position == pytest.approx(np.array([[25.4, 0, 0], [76.2, 0, 0]]))


@pytest.mark.parametrize(
    ("dialect", "statements", "place"),
    [  # the point 1,2,3; a quarter turn takes x,y to -y,x
        ("creo", "TRACUT/10,0,0\n", [11, 2, 3]),
        ("creo", "TRACUT/0,-1,0,10,1,0,0,0,0,0,1,0\n", [8, 1, 3]),
        ("creo", "TRACUT/10,0,0\nTRACUT/LAST,0,-1,0,0,1,0,0,0,0,0,1,0\n", [-2, 11, 3]),
        ("creo", "TRACUT/LAST,0,-1,0,0,1,0,0,0,0,0,1,0\nTRACUT/10,0,0\n", [-2, 11, 3]),
        ("creo", "TRACUT/10,0,0\nTRACUT/LAST,5,5,5\nTRACUT/NOMORE\n", [6, 7, 8]),
        ("creo", "TRACUT/10,0,0\nTRACUT/LAST,5,5,5\nTRACUT/LAST,NOMORE\n", [11, 2, 3]),
        ("creo", "TRACUT/10,0,0\nTRACUT/0,20,0\n", [1, 22, 3]),
        ("creo", "TRACUT/10,0,0\nTRANS/0,0,1\nORIGIN/0,0,5\n", [11, 2, -1]),
    ],
)
def test_tracut_and_its_last_one_apply_in_this_order(dialect, statements, place):
    found, _ = read(f"{HEAD}{statements}GOTO/1,2,3\nFINI\n", "part.cl", ReadOptions(dialect=dialect))
    assert found.position[-1] == pytest.approx(place)


@pytest.mark.parametrize(("dialect", "place"), [("creo", [-2, 11, 3]), ("catia", [8, 1, 3])])
def test_copies_come_after_tracut_and_for_catia_before(dialect, place):
    """ICAM: ANSI APT has TRACUT, COPY, TRACUT/LAST; CATIA has COPY, TRACUT, TRACUT/LAST."""
    text = f"{HEAD}TRACUT/10,0,0\nINDEX/1\nGOTO/1,2,3\nCOPY/1,XYROT,90,1\nTRACUT/NOMORE\nGOTO/0,0,0\nFINI\n"
    found, _ = read(text, "part.cl", ReadOptions(dialect=dialect))
    assert found.position[1:].tolist() == [[11, 2, 3], pytest.approx(place), [0, 0, 0]]


def test_tracut_moves_points_in_the_frame_they_are_written_in():
    text = "UNITS/MM\nFEDRAT/60\nMSYS/0,0,0,1,0,0,0,1,0\nMSYS/0,0,0,0,1,0,-1,0,0\nTRACUT/10,0,0\nGOTO/1,2,3\nFINI\n"
    assert read(text, "part.cl", ReadOptions(dialect="nx"))[0].position.tolist() == [[-2, 11, 3]]


def test_each_word_ends_its_own_frame():
    given = "TRACUT/1,0,0\nTRACUT/LAST,0,1,0\nORIGIN/0,0,-1\nTRANS/0,0,2\nGOTO/0,0,0\n"
    ends = ("TRACUT/NOMORE", "TRACUT/LAST,NOMORE", "ORIGIN/NOMORE", "TRANS/OFF")
    found = program(given + "".join(f"{word}\nGOTO/0,0,0\n" for word in ends)).position[1:].tolist()
    assert found == [[1, 1, 3], [0, 1, 3], [0, 0, 3], [0, 0, 2], [0, 0, 0]]


def test_increments_and_events_are_copied():
    found = program("INDEX/1\nGOTO/1,0,0\nSPINDL/500,CLW\nGODLTA/0,0,1\nCOPY/1,XYROT,90,1\n")
    assert found.position[1:] == pytest.approx(np.array([[1, 0, 0], [1, 0, 1], [0, 1, 0], [0, 1, 1]]))
    assert [event.row for event in found.events if event.value == 500] == [2, 4]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("INDEX/1\nGOTO/1,2,3\nCOPY/2,SAME,1\n", "L402"),
        ("INDEX/1\nINDEX/1\nGOTO/1,2,3\nCOPY/1,SAME,1\n", "L402"),
        ("COPY/1,SAME,1\nINDEX/1\n", "L402"),
        ("INDEX/1\nGOTO/1,2,3\nCOPY/1,SAME,0\n", "L402"),
        ("INDEX/1\nGOTO/1,2,3\nCOPY/1,SAME,1.5\n", "L402"),
        ("INDEX/1\nGOTO/1,2,3\nCOPY/1,TRANSL,1,2,1\n", "L402"),
        ("INDEX/1\nGOTO/1,2,3\nCOPY/1,MIRROR,1\n", "L402"),
        ("INDEX/1\nGOTO/1,2,3\nCOPY/1\n", "L402"),
        ("INDEX/1\nGOTO/1,2,3\nCOPY/1,MODIFY,-1,0,0,0,0,1,0,0,0,0,1,0,1\n", "L403"),
        ("INDEX/1,NOMORE\nGOTO/1,2,3\n", "L402"),
        ("INDEX/1\nGOTO/1,2,3\nCOPY/1,SAME,20000000\n", "L403"),
        ("INDEX/1\nINDEX/2\nGOTO/1,2,3\nCOPY/2,TRANSL,1,0,0,1\nCOPY/1,XYROT,90,1\n", "L401"),
        ("INDEX/1\nGOTO/1,2,3\nINDEX/2\nGOTO/1,2,3\nCOPY/1,TRANSL,1,0,0,1\nCOPY/2,TRANSL,1,0,0,1\n", "L401"),
        ("INDEX/1\nINDEX/2\nGOTO/1,2,3\nCOPY/2,SAME,4000\nCOPY/1,SAME,4000\n", "L403"),
        ("TRACUT/LAST\nGOTO/1,2,3\n", "L402"),
        ("INDEX/1\nSPINDL/9\nGODLTA/0,0,-1\nGOTO/0,0,9\nCOPY/1,TRANSL,9,0,0,1\n", "L401"),
        ("INDEX/1\nGOTO/1,2,3\nGOTO/1,2,9,0.6,0,0.8\nCOPY/1,TRANSL,9,0,0,2\n", "L401"),
        ("INDEX/1\nGODLTA/0,0,-1\nCOPY/1,SAME,2\n", "L401"),
    ],
)
def test_copies_that_are_refused(text, code):
    assert codes(text) == [code]


@pytest.mark.parametrize(
    ("inner", "outer", "places"),
    [
        ("TRANSL,10,0,0,2", "TRANSL,0,5,0,1", [[1 + 10 * i, 5 * j, 0] for j in range(2) for i in range(3)]),
        ("TRANSL,0,0,4,1", "XYROT,90,1", [[1, 0, 0], [1, 0, 4], [0, 1, 0], [0, 1, 4]]),
        ("SAME,1", "TRANSL,3,0,0,1", [[1, 0, 0], [1, 0, 0], [4, 0, 0], [4, 0, 0]]),
    ],
)
def test_a_copied_path_is_copied_with_its_copies(inner, outer, places):
    text = f"INDEX/1\nINDEX/2\nGOTO/1,0,0\nCOPY/2,{inner}\nGODLTA/0,0,1\nCOPY/1,{outer}\n"
    found = program(text).position[1:]
    rising = places[len(places) // 2 - 1 :: len(places) // 2]
    expected = [*places[: len(places) // 2], rising[0], *places[len(places) // 2 :], rising[1]]
    expected[len(places) // 2] = [*rising[0][:2], rising[0][2] + 1]
    expected[-1] = [*rising[1][:2], rising[1][2] + 1]
    assert found == pytest.approx(np.array(expected, dtype=float))


def test_a_file_without_copies_keeps_its_table():
    from pkm_post.reading.cldata.diagnostics import StatementDiagnostics
    from pkm_post.reading.cldata.logical_lines import logical_lines
    from pkm_post.reading.cldata.statements import scan

    statements = scan(logical_lines(HEAD), StatementDiagnostics("part.cl"))
    assert copies.with_copies(statements, StatementDiagnostics("part.cl")) is statements


@pytest.mark.parametrize("change", ["UNITS/INCHES", "TRACUT/5,0,0", "TRACUT/LAST,5,0,0"])
def test_a_unit_or_frame_that_changes_within_a_path_is_refused(change):
    """The first points of the copies would be in those of the end: copies in inches were 25.4 times as big."""
    path = "INDEX/1\nGOTO/1,0,0\nGOTO/2,1,0\n"
    assert codes(f"{path}{change}\nCOPY/1,TRANSL,10,0,0,1\nGOTO/0,0,60\n") == ["L401"]


@pytest.mark.parametrize(
    ("before", "first", "last", "x"),
    [
        ("", "", "UNITS/MM", [1, 2, 11, 12]),
        ("", "UNITS/INCHES", "", [25.4, 50.8, 279.4, 304.8]),
        ("TRACUT/5,0,0", "", "", [6, 7, 16, 17]),
        ("", "TRACUT/5,0,0", "TRACUT/7,0,0", [6, 7, 16, 17]),
        ("", "", "TRACUT/5,0,0\nTRACUT/NOMORE", [1, 2, 11, 12]),
        ("TRACUT/LAST,1,0,0", "", "TRACUT/5,0,0\nTRACUT/OFF", [2, 3, 12, 13]),
    ],
)
def test_a_unit_or_frame_that_holds_for_the_whole_path_is_copied(before, first, last, x):
    found = program(f"{before}\nINDEX/1\n{first}\nGOTO/1,0,0\nGOTO/2,0,0\n{last}\nCOPY/1,TRANSL,10,0,0,1\n")
    assert found.position[-4:, 0] == pytest.approx(x)
