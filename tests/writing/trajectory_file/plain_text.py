# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fields of a trajectory file as words, by the Python layout, to compare with readers in other languages."""

import math

from pkm_post.writing.trajectory_file.layout import STRING, TABLE, TABLES
from pkm_post.writing.trajectory_file.reader import opened


def lines_of(content):
    """A line for the header and one for each record, in the order of the tables, but for the text."""
    header, tables = opened(content)
    text = tables["text"].tobytes()
    yield " ".join(["header", *words(header, text)])
    for name in TABLES:
        if name != "text":
            yield from (" ".join([name, *words(record, text)]) for record in tables[name])


def words(record, text):
    """Name and value of each field of a record."""
    for name, (dtype, *_) in record.dtype.fields.items():
        if dtype == TABLE:
            yield from (word for part in TABLE.names for word in (f"{name}.{part}", str(record[name][part])))
            continue
        yield name
        if dtype == STRING:
            begin, size = record[name].item()
            yield text[begin : begin + size].hex()
        elif dtype.kind == "S" or (dtype.shape and dtype.base.itemsize == 1):
            yield record[name].tobytes().hex() if dtype.shape else record[name].ljust(dtype.itemsize, b"\0").hex()
        elif dtype.base.kind == "f":
            yield from map(real, record[name].ravel().tolist())
        else:
            yield str(record[name])


def real(value):
    """A number with all its digits, as C has it."""
    return "nan" if math.isnan(value) else f"{value:.17g}"
