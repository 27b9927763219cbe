# SPDX-License-Identifier: LGPL-2.1-or-later
"""Without lark, reading G-code says what to install."""

import sys

import pytest

from pkm_post.reading.gcode.scan import scan, scan_by_block
from pkm_post.reading.grammar import parser_of


@pytest.mark.parametrize("way", [scan, scan_by_block])
def test_a_missing_lark_is_named(monkeypatch, way):
    parser_of.cache_clear()
    monkeypatch.setitem(sys.modules, "lark", None)
    with pytest.raises(ImportError, match="needs lark: install python3-lark, or type: pip install lark"):
        way("G1 X1", "part.ngc")
