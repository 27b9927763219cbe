# SPDX-License-Identifier: LGPL-2.1-or-later
"""The grammar of record of one block."""

from pathlib import Path

from pkm_post.reading.grammar import Grammar

BLOCK = Grammar(Path(__file__).with_name("block.lark"), start="block", reads="G-code")
