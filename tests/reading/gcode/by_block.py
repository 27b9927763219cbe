# SPDX-License-Identifier: LGPL-2.1-or-later
"""The reference of ``scan``: every line is parsed with lark, alone."""

from pkm_post.model import errors
from pkm_post.reading.gcode import scan as scanning
from pkm_post.reading.gcode.block_builders import BlocksBuilder
from pkm_post.reading.gcode.blocks import Block
from pkm_post.reading.gcode.parse import parse_line
from pkm_post.reading.gcode.syntax_faults import SyntaxFaults


def scan_by_block(text, file):
    """The blocks, None if there are faults; and the diagnostics."""
    whole = scanning.with_line_feeds(text)
    part = scanning._up_to_percent(whole)
    faults, builder = SyntaxFaults(file), BlocksBuilder(part.text.count(b"\n"))
    for line in part.text.split(b"\n")[:-1]:
        block = parse_line(line)
        if isinstance(block, Block):
            messages = []
            scanning._without_comments(line, messages)
            builder.comments.extend((builder.next_line, message) for _, message in messages)
            builder.add(block)
        else:
            faults.add(builder.next_line, line, block)
            builder.add(Block())
    blocks, diagnostics = scanning._scanned(whole, part, builder, faults, file)
    return None if errors(diagnostics) else blocks, diagnostics
