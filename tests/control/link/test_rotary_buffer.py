# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rotary buffer of a simulated controller, opened by the link."""

import re

import pytest
from rig import SETTINGS
from streams import JOB, WORDS, wired

from pkm_post.control.link.rotary_buffer import RotaryBuffer
from pkm_post.writing.controllers.pmac import rotary_opening


@pytest.mark.parametrize("kind", ["serial", "tcp"])
def test_it_is_opened_by_the_lines_of_the_rotary_form_and_what_lay_in_it_is_gone(kind):
    wire = wired(kind)
    with wire.session() as session:
        buffer = RotaryBuffer(session, SETTINGS, JOB.program.lines, WORDS)
        buffer.open()
        assert buffer.send(3) and buffer.lines_ahead() == buffer.loaded > 0
        wire.sent.clear()
        buffer.open()
        assert buffer.lines_ahead() == 0 and not wire.controller.memory.rotaries[1].lines
    lines = b".*?".join(re.escape(line.encode("ascii")) for line in rotary_opening(SETTINGS))
    assert re.search(lines, bytes(wire.sent), re.DOTALL)
