# SPDX-License-Identifier: LGPL-2.1-or-later
"""docs/machine-file.md and the table of fields say the same."""

import re
from pathlib import Path

from pkm_post.machine.description.faults import DEEPEST, MOST_BYTES, MOST_SHOWN
from pkm_post.machine.description.fields import FIELDS, REQUIRED
from pkm_post.machine.description.units import DIMENSIONS, MILLISECONDS, PLAIN, UNITS

DOCUMENT = (Path(__file__).parents[3] / "docs" / "machine-file.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| `([^`]+)` \| (.*?) \| (.*?) \| (.*?) \| (.*?) \|$", re.MULTILINE)


def default_in_words(default):
    return {id(REQUIRED): "required", id(None): "none"}.get(id(default)) or (str(default) or "empty")


def test_document_describes_every_entry_as_the_table_has_it():
    described = [row[:4] for row in ROW.findall(DOCUMENT)]
    stated = [
        (field.entry, field.form.words, field.dimension.unit, default_in_words(field.default)) for field in FIELDS
    ]
    assert described == stated


def test_every_entry_has_a_meaning():
    assert all(len(row[4]) > 10 for row in ROW.findall(DOCUMENT))


def test_document_names_every_unit():
    assert all(f'"{unit}"' in DOCUMENT for sizes in UNITS.values() for unit in sizes)


def test_document_names_every_code():
    assert all(f"M10{number}" in DOCUMENT for number in range(1, 8))
    assert all(f"| M{number} | " in DOCUMENT for number in range(206, 209))


def test_document_has_the_sizes_that_make_sense():
    _, found = DOCUMENT.split("| quantity | unit | smallest above 0 | largest |\n|---|---|---|---|\n")
    sizes = [f"| {each.noun} | {each.unit} | {each.least:g} | {each.most:g} |" for each in DIMENSIONS]
    assert found.split("\n\n")[0].splitlines() == sizes
    assert {field.dimension for field in FIELDS} - {*DIMENSIONS} == {PLAIN, MILLISECONDS}


def test_document_has_the_limits_of_the_text():
    assert f"at most {MOST_BYTES} bytes" in DOCUMENT
    assert f"at most {DEEPEST} deep" in DOCUMENT
    assert f"more than {MOST_SHOWN} faults the first {MOST_SHOWN}" in DOCUMENT
