# SPDX-License-Identifier: LGPL-2.1-or-later
"""The grammar of record of one statement, without comments, its lines joined."""

from pathlib import Path

from pkm_post.reading.grammar import Grammar

STATEMENT = Grammar(Path(__file__).with_name("statement.lark"), start="statement", reads="CL data", empty_parts=True)
