# SPDX-License-Identifier: LGPL-2.1-or-later
"""Resolve: plain blocks become a program.

Blocks in the units they are written in enter; columns in mm, mm/s and unit vectors in {C} leave, every modal word
resolved, cycles as moves, arcs with centre and axis; or what is wrong with the blocks. Moves before X, Y and Z are all
known go to no place and are folded into the first one whose end is known. What follows M2 or M30 is not read.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.gcode.arc_motions import arcs_of, known_ones, lengths, single_turns
from pkm_post.gcode.axes import tool_axes
from pkm_post.gcode.blocks import Blocks, column_of
from pkm_post.gcode.checks import check
from pkm_post.gcode.feeds import feeds
from pkm_post.gcode.findings import Findings
from pkm_post.gcode.frames import RowFrames, normal_coordinate
from pkm_post.gcode.happenings import ENDS, events, happenings
from pkm_post.gcode.magazine import side_offsets, spindle_speeds, tools_in_spindle
from pkm_post.gcode.modal import NONE, Group, Modal, modal_state, owners
from pkm_post.gcode.options import AXIS_WORDS, UNITS, ReadOptions
from pkm_post.gcode.walk import Motions, Walk
from pkm_post.model import Diagnostic, Kind, Program, Tool
from pkm_post.model.program import Array

_ALONG_AN_AXIS = 1 - 1e-9


def resolve(blocks: Blocks, options: ReadOptions) -> tuple[Program | None, tuple[Diagnostic, ...]]:
    """The program that plain blocks describe.

    Args:
        blocks: blocks without parameters, expressions and O words, in the order in which they are executed.
        options: what the program does not say itself.

    Returns:
        The program, None if there are errors; and the diagnostics in the order of the lines.

    Raises:
        ValueError: the blocks are not plain.
    """
    if blocks.special:
        raise ValueError(f"expected plain blocks, got {len(blocks.special)} that have to be executed first")
    blocks = _read(blocks, options)
    faults = Findings(blocks)
    modal = modal_state(blocks, UNITS[options.unit], AXIS_WORDS[options.axis_words])
    check(blocks, modal, options, faults)
    if faults.stop():
        return None, faults.in_order()
    program = _program(blocks, modal, options, faults)
    return None if faults.stop() else program, faults.in_order()


def _read(blocks: Blocks, options: ReadOptions) -> Blocks:
    """The blocks that are carried out: without deleted ones, up to the end of the program."""
    ends = owners(blocks.m_start)[np.isin(blocks.m, ENDS)]
    if options.block_delete:
        ends = ends[~blocks.deleted[ends]]
    until = int(ends[0]) + 1 if len(ends) else len(blocks)
    if until == len(blocks) and not (options.block_delete and blocks.deleted.any()):
        return blocks
    keep = np.arange(len(blocks)) < until
    if options.block_delete:
        keep &= ~blocks.deleted
    codes = {}
    for name in ("g", "m"):
        start = getattr(blocks, f"{name}_start")
        codes[name] = getattr(blocks, name)[keep[owners(start)]]
        codes[f"{name}_start"] = np.append(0, np.cumsum(np.diff(start)[keep]))
    return replace(blocks, line=blocks.line[keep], words=blocks.words[keep], deleted=blocks.deleted[keep], **codes)


def _program(blocks: Blocks, modal: Modal, options: ReadOptions, faults: Findings) -> Program | None:
    tools = tools_in_spindle(blocks, modal, options, faults)
    spindle = spindle_speeds(blocks, modal)
    sides = side_offsets(blocks, modal, tools, options, faults)
    upright = tool_axes(blocks, modal, options, faults)
    _tolerances(modal, blocks, faults)
    motions = Walk(blocks, modal, tools, spindle, options, faults).motions()
    centre, axis = arcs_of(blocks, modal, motions, faults)
    if faults.stop():
        return None
    motions, centre, axis = known_ones(*single_turns(blocks, modal, motions, centre, axis))
    block = motions.block
    if not len(block):
        faults.tell("G420", 0, f"{len(blocks)} blocks")
        return None
    frames = RowFrames.of(motions.frames, motions.frame)
    tilted = upright[block]
    turns = np.append(True, np.any(tilted[1:] != tilted[:-1], axis=1))
    way = lengths(motions, centre, axis)
    side, plane = _compensation(blocks, modal, motions, frames, sides, faults)
    return Program(
        kind=np.select([motions.motion == 0, motions.motion == 10], [Kind.RAPID, Kind.LINE], Kind.ARC),
        position=frames.points(motions.end),
        tool_axis=frames.directions(tilted),
        feed=feeds(blocks, modal, spindle, block, motions.motion != 0, way, turns, faults),
        arc_centre=frames.points(centre),
        arc_axis=frames.hand()[:, None] * frames.directions(axis),
        operation=np.zeros(len(block)),
        line=blocks.line[block],
        events=events(happenings(blocks, modal, tools, spindle), motions.in_cycles, block),
        operations=("",),
        tools=_tools(tools, options),
        source=blocks.source,
        exact_stop=np.isin(modal.in_force[Group.PATH], (610, 611))[block],
        side_offset=side,
        plane=plane,
    )


def _tolerances(modal: Modal, blocks: Blocks, faults: Findings) -> None:
    wanted = (modal.explicit[Group.PATH] == 640) & ~np.isnan(blocks.words[:, column_of("P")])
    faults.tell_all("G417", wanted, lambda row: f"G64 P{blocks.words[row, column_of('P')]:g}")


def _compensation(
    blocks: Blocks, modal: Modal, motions: Motions, frames: RowFrames, sides: Array, faults: Findings
) -> tuple[Array, Array]:
    """Side offset and plane of each motion in {C}, (n,) each: a mirror changes the side."""
    plane, along = frames.planes(normal_coordinate(modal.in_force[Group.PLANE])[motions.block])
    side = sides[motions.block]
    oblique = np.zeros(len(blocks), dtype=np.bool_)
    oblique[motions.block[(side != 0) & (np.abs(along) < _ALONG_AN_AXIS)]] = True
    faults.tell_all("G419", oblique, lambda _: "the plane is turned out of X, Y and Z")
    return side * np.sign(along) * frames.hand(), plane


def _tools(numbers: Array, options: ReadOptions) -> dict[int, Tool]:
    """The tools in use, by number."""
    called = [number for number in np.unique(numbers).tolist() if number != NONE]
    found = {number: replace(tool, number=number) for number in called if (tool := options.tool(number))}
    if not found and options.default_tool is not None:
        return {options.default_tool.number: options.default_tool}
    return found
