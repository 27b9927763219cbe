# SPDX-License-Identifier: LGPL-2.1-or-later
"""docs/machine-file.md and the table of fields say the same."""

import re
from pathlib import Path

from pkm_post.machine_file.fields import FIELDS, REQUIRED
from pkm_post.machine_file.units import UNITS

DOCUMENT = (Path(__file__).parents[2] / "docs" / "machine-file.md").read_text(encoding="utf-8")
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
