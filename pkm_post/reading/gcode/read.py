# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read: convert the text of a G-code program to motions, in three independent steps.

Input: the content of a file, in its own units. Output: a ``Program`` in mm, rad and mm/s, or all faults. If a step
fails, the later ones check the rest of the program for independent faults.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from pkm_post.model import Diagnostic, Diagnostics, Place, errors
from pkm_post.reading.gcode.blocks import PROGRAM_END, SUBPROGRAM_CODES, Blocks
from pkm_post.reading.gcode.flavours import FLAVOURS, RS274, Flavour
from pkm_post.reading.gcode.foreign import foreign_language
from pkm_post.reading.gcode.guess import guessed_flavour
from pkm_post.reading.gcode.options import DEFAULT_LIMITS, DEFAULT_OPTIONS, ExecutionLimits, ReadOptions, ReadResult
from pkm_post.reading.gcode.recovery import first_line, merged, own_faults
from pkm_post.reading.gcode.resolve import resolve
from pkm_post.reading.gcode.scan import scan_recovering, with_line_feeds
from pkm_post.reading.gcode.subprograms import Source, with_operations, with_places


def _without_a_point(letters: str) -> re.Pattern[bytes]:
    """A word with one of some letters, whose value is a whole number other than 0, without a point."""
    word = rf"(?<![A-Za-z#\]])[{letters}{letters.lower()}][ \t]*[+-]?0*[1-9]\d*(?![\d. \t]*[.\d])"
    return re.compile(word.encode())


_COMMENT = re.compile(rb"\([^()\n]*\)|;[^\n]*")
_COORDINATE_WITHOUT_A_POINT = _without_a_point("XYZIJRABC")
"""A coordinate, radius or angle."""
_PECKS = re.compile(rb"^[^\n]*[Gg]0*[78]3(?![\d.])[^\n]*", re.MULTILINE)
_PECK_WITHOUT_A_POINT = _without_a_point("Q")
"""Q of G73 and G83; many controls take none there, and count thousandths."""
_MACRO_CALL = re.compile(rb"^[^\n]*[Gg]0*6[56](?![\d.])[^\n]*", re.MULTILINE)
_ARGUMENT_WITHOUT_A_POINT = _without_a_point("ABCEFKQRUVW")
"""An argument of a macro: it counts in the least increment of its address [Fanuc, custom macro]."""
_RESTARTS = ("M99 ends the main program, which a control would begin again: it is carried out once",)


def read(
    text: bytes | str, file: str, options: ReadOptions = DEFAULT_OPTIONS, limits: ExecutionLimits = DEFAULT_LIMITS
) -> ReadResult:
    """Read a G-code program from any bytes.

    Returns:
        The program, or None if there are errors; and the diagnostics.

    Raises:
        ImportError: lark is not installed.
    """
    scanned, syntax = scan_recovering(text, file)
    flavour, why = _flavour(scanned, options)
    options = replace(options, flavour=flavour.name)
    is_whole = not errors(syntax)
    source, executed, execution = _executed(Source(scanned, text), options, limits, is_whole)
    files, syntax = executed.files, syntax + source.warnings
    if not is_whole or execution:
        return None, _all_faults(source.text, file, executed, syntax + execution, options)
    program, meaning = resolve(executed, options, source.text)
    points = _lengths_without_a_point(source.text, file) if flavour.counts_thousandths else ()
    diagnostics = syntax + merged(with_places((*meaning, *points, *_other_programs(source.blocks, executed)), files))
    if program is None:
        return None, diagnostics
    notes = (why, *source.notes, *program.reading, *_RESTARTS[: executed.restarts])
    return replace(with_operations(program, files), reading=notes), diagnostics


def _executed(
    source: Source, options: ReadOptions, limits: ExecutionLimits, is_whole: bool
) -> tuple[Source, Blocks, Diagnostics]:
    """Execute a program with the files of its subprograms; each file is added when found missing.

    The interpreter is only imported for programs that need it.
    """
    if source.blocks.is_plain:
        return source, source.blocks, ()
    from pkm_post.reading.gcode.calls import MissingProgram
    from pkm_post.reading.gcode.execute import execute_as_far_as_possible
    from pkm_post.reading.gcode.system_variables import ExecutedBlocks

    flavour, may_add = FLAVOURS[options.flavour or RS274.name], bool(options.folders)
    where = partial(ExecutedBlocks, options=options)
    of_files: Diagnostics = ()
    while True:
        blocks = source.blocks
        text = with_line_feeds(source.text) if blocks.special else b""
        try:
            executed, faults = execute_as_far_as_possible(
                blocks, limits, options.block_delete, flavour, is_whole, text, may_add, where
            )
        except MissingProgram as missing:
            longer, of_files = source.with_file(missing, options.folders)
            may_add = longer is not source and len(longer.blocks.files) < limits.files
            source = longer
        else:
            return source, executed, of_files if errors(of_files) else faults


def _other_programs(blocks: Blocks, executed: Blocks) -> Iterator[Diagnostic]:
    """A warning about each program with an end of its own, M2 or M30, of which no block was executed."""
    words = ((row, child) for row, tree in sorted(blocks.special.items()) for child in tree.children)
    bare = ((row, word) for row, word in words if not isinstance(word, str) and word.data == "o_word")
    numbers = [(row, word.children[0]) for row, word in bare if len(word.children) == 1]
    ends = blocks.rows_of_m(*PROGRAM_END)
    for (row, number), (behind, _) in itertools.pairwise((*numbers, (len(blocks), None))):
        has_end = ((ends > row) & (ends < behind)).any()
        if has_end and not np.isin(executed.line, blocks.line[row:behind]).any():
            yield Diagnostic("G215", blocks.place(row), f"O{number}")


def _lengths_without_a_point(text: bytes | str, file: str) -> Diagnostics:
    """A warning about whole numbers as coordinates, at the first of them."""
    raw = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else bytes(text)
    plain = _COMMENT.sub(lambda comment: b" " * len(comment[0]), raw) if b"(" in raw or b";" in raw else raw
    places = {place.start(): place for place in _COORDINATE_WITHOUT_A_POINT.finditer(plain)}
    for lines, words in ((_MACRO_CALL, _ARGUMENT_WITHOUT_A_POINT), (_PECKS, _PECK_WITHOUT_A_POINT)):
        for block in lines.finditer(plain):
            places |= {place.start(): place for place in words.finditer(plain, *block.span())}
    if not places:
        return ()
    found, number = places[min(places)], len(places)
    line = plain.count(b"\n", 0, found.start()) + 1
    column = found.start() - plain.rfind(b"\n", 0, found.start())
    more = f", and {number - 1} more like it" if number > 1 else ""
    return (Diagnostic("G214", Place(file, line=line, column=column), found[0].decode("latin-1") + more),)


def _all_faults(text: bytes | str, file: str, blocks: Blocks, faults: Diagnostics, options: ReadOptions) -> Diagnostics:
    """The faults of a text that cannot be executed, then those of its blocks; or its foreign language."""
    language = foreign_language(with_line_feeds(text))
    if language is not None:
        return (Diagnostic("G213", Place(file, line=language[1]), language[0]),)
    _, meaning = resolve(blocks, replace(options, needs_end=False), text)
    calls = blocks.line[blocks.rows_of_m(*SUBPROGRAM_CODES)]  # calls that were not executed
    own = own_faults(meaning, first_line(faults), options)
    listed = sorted(
        (*faults, *(fault for fault in own if fault.place.line not in calls)),
        key=lambda fault: (fault.place.line, fault.place.column),
    )
    return merged(with_places(listed, blocks.files))


def _flavour(blocks: Blocks, options: ReadOptions) -> tuple[Flavour, str]:
    """The chosen or guessed flavour, with the reason for the report."""
    if options.flavour is not None:
        return FLAVOURS[options.flavour], f"flavour {options.flavour}, as chosen"
    guess = guessed_flavour(blocks)
    return guess.flavour, str(guess)
