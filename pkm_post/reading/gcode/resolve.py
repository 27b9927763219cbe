# SPDX-License-Identifier: LGPL-2.1-or-later
"""Resolve: convert plain blocks to a program.

Input: blocks in the units as written. Output: columns in mm, mm/s and unit vectors in {C}, every modal word resolved,
cycles as moves, arcs with centre and axis; or the faults of the blocks. Moves before X, Y and Z are all known have no
end point and are merged into the first one with a known end point. Text after M2 or M30 is ignored; without these or a
percent sign a file may be truncated.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import angle_between, dot
from pkm_post.model import (
    Array,
    Diagnostics,
    Kind,
    Program,
    Tool,
    checkpoint,
    distinct,
    is_uniform,
    map_rows,
    read_only,
    uniform,
)
from pkm_post.reading.gcode.adapt import adapted
from pkm_post.reading.gcode.arcs import arc_geometry, path_lengths, split_turns, with_known_ends
from pkm_post.reading.gcode.blocks import Blocks, bits_of
from pkm_post.reading.gcode.checks import check
from pkm_post.reading.gcode.codes import NONE, Group
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics, never_given
from pkm_post.reading.gcode.events import ENDS, check_dwells, dwell_words, events_of_blocks, ordered_events
from pkm_post.reading.gcode.feeds import INVERSE_TIME, feeds, path_modes
from pkm_post.reading.gcode.flavours import flavour_on_machine
from pkm_post.reading.gcode.frames import RowFrames, normal_coordinate
from pkm_post.reading.gcode.modal import Modal, modal_state
from pkm_post.reading.gcode.motions import Motions
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.gcode.position_tracker import PositionTracker
from pkm_post.reading.gcode.recovery import first_line, own_faults
from pkm_post.reading.gcode.tapping import with_leads
from pkm_post.reading.gcode.tilted_planes import check_tilted_planes, check_unknown_positions_after_turns
from pkm_post.reading.gcode.tool_axes import axes_in_work_frame, check_cycles, spins, surface_normals, tool_axes
from pkm_post.reading.gcode.tools import side_offsets, spindle_speeds, tools_in_spindle

_ALONG_AN_AXIS = 1 - 1e-9
_KIND = np.zeros(31, np.uint8)
_KIND[[0, 10, 20, 30]] = Kind.RAPID, Kind.LINE, Kind.ARC, Kind.ARC
"""Motion kind by G code."""


def resolve(blocks: Blocks, options: ReadOptions, text: bytes | str = "") -> tuple[Program | None, Diagnostics]:
    """Convert plain blocks in execution order to a program; without a flavour among the options they are RS274NGC.

    The source text, if available, serves the columns of diagnostics, and the points of integers.

    Returns:
        The program, or None if there are errors; and the diagnostics in line order.

    Raises:
        ValueError: the blocks are not plain.
    """
    if blocks.special:
        raise ValueError(f"expected plain blocks, got {len(blocks.special)} that have to be executed first")
    flavour = flavour_on_machine(options)
    blocks, ended = _up_to_end(blocks, options)
    blocks, notes = adapted(blocks, flavour, options.left_out, options.unit)
    faults = BlockDiagnostics(blocks, text, options.most_reported)
    modal = modal_state(blocks, options, flavour)
    check(blocks, modal, options, faults)
    if (modal.programmed[Group.SCALING] != NONE).any():
        from pkm_post.reading.gcode.scaling import scaled

        blocks = scaled(blocks, modal, faults)
        modal = modal_state(blocks, options, flavour)
    check_dwells(blocks, modal, options, faults)
    program = None if faults.has_errors() else _program(blocks, modal, options, faults)
    behind = _faults_behind(blocks, modal, options, faults) if program is None else ()
    if options.needs_end and not ended:
        faults.add("G430", len(blocks) - 1, "no M2, M30 or % after it")
    if program is None or faults.has_errors():
        return None, tuple(sorted((*faults.in_order(), *behind), key=lambda fault: (fault.place.line, fault.code)))
    if options.feed is not None:
        notes = (*notes, f"the feed before the first F is {options.feed * 60:.10g} mm/min, as the option says")
    return replace(program, reading=notes), faults.in_order()


def _faults_behind(blocks: Blocks, modal: Modal, options: ReadOptions, faults: BlockDiagnostics) -> Diagnostics:
    """Independent faults of the motions of a program, from its blocks without faults.

    Empty if the rest has no motion, or is faulty only because blocks are missing.
    """
    rest = np.setdiff1d(np.arange(len(blocks)), [*faults.faulty])
    if len(rest) in (0, len(blocks)):
        return ()
    blocks = blocks.selected(rest)
    modal = modal_state(blocks, options, modal.flavour)
    others = BlockDiagnostics(blocks, faults.text, options.most_reported)
    check(blocks, modal, options, others)
    if others.has_errors():
        return ()
    _program(blocks, modal, options, others)
    return own_faults(others.in_order(), first_line(faults.in_order()), options)


def _up_to_end(blocks: Blocks, options: ReadOptions) -> tuple[Blocks, bool]:
    """The blocks to execute, without deleted ones, up to the program end; and whether there is a program end."""
    ends = blocks.rows_of_m(*ENDS)
    skipped = (blocks.deleted & bits_of(options.block_delete)) != 0
    ends = ends[~skipped[ends]]
    if len(ends):
        blocks = blocks.first(int(ends[0]) + 1)
    if skipped.any():
        blocks = blocks.selected(np.flatnonzero(~skipped[: len(blocks)]))
    return blocks, blocks.closed or bool(len(ends))


def _report_no_motion(blocks: Blocks, first: list[int], known: Array, faults: BlockDiagnostics) -> None:
    """Report a program without moves, or the first move if none has a known position."""
    if first:
        faults.add("G436", first[0], never_given(known))
    else:
        faults.add("G420", 0, f"{len(blocks)} blocks")


class BlockStates(NamedTuple):
    """State of each block, apart from positions and modal codes.

    Attributes:
        tools: (N,) number of the tool in the spindle.
        spindle: (N,) signed spindle speed, 1/min.
        sides: (N,) radius of the 2D compensation, mm.
        axes: (N, 3) unit tool axis in program coordinates.
        written: (N,) whether the block has words for it.
        lost: (N,) knowledge of the tip position after each block, as in ``tool_axes``.
        normals: (N, 3) unit surface normal in program coordinates, or NaN.
        spins: (N,) rotation of the platform about the tool axis, rad, or NaN.
    """

    tools: Array
    spindle: Array
    sides: Array
    axes: Array
    written: Array
    lost: Array
    normals: Array
    spins: Array


def block_states(blocks: Blocks, modal: Modal, options: ReadOptions, faults: BlockDiagnostics) -> BlockStates:
    """The states of all blocks."""
    tools = tools_in_spindle(blocks, modal, options, faults)
    checkpoint()
    axes, lost, written = tool_axes(blocks, modal, options, faults)
    checkpoint()
    check_cycles(modal, axes, faults)
    check_tilted_planes(blocks, modal, axes, faults)
    return BlockStates(
        tools=tools,
        spindle=spindle_speeds(blocks, modal),
        sides=side_offsets(blocks, modal, tools, options, faults),
        axes=axes,
        written=written,
        lost=lost,
        normals=surface_normals(blocks, faults),
        spins=spins(blocks, modal, options),
    )


def _program(blocks: Blocks, modal: Modal, options: ReadOptions, faults: BlockDiagnostics) -> Program | None:
    """The program, or None with the faults added that prevent it."""
    states = block_states(blocks, modal, options, faults)
    checkpoint()
    modes = path_modes(blocks, modal, faults)
    checkpoint()
    dwells = dwell_words(blocks, modal, options)
    tracker = PositionTracker(blocks, modal, states.tools, states.spindle, dwells, states.lost, options, faults)
    path = _path(blocks, modal, tracker, states.lost, options, faults)
    if path is None:
        return None
    motions = path.motions
    columns = _columns(blocks, modal, states, path, options, faults)
    columns |= {name: motions.of_blocks(column) for name, column in modes.items()}
    events = ordered_events(
        events_of_blocks(blocks, modal, states.tools, states.spindle, dwells), motions.in_cycles, motions.block
    )
    return Program(
        **{name: read_only(column) for name, column in columns.items()},
        events=with_leads(events, blocks, motions, columns["feed"], faults),
        operations=("",),
        tools=_tools(states.tools, options),
        source=blocks.source,
        source_fingerprint="",
        reading=(),
        length_offsets=frozenset(tracker.offset_codes.length_offsets),
    )


class _Path(NamedTuple):
    """Motions with known end points, in program coordinates.

    Attributes:
        motions: n motions.
        arc_centre: (n, 3) mm, NaN for lines.
        arc_axis: (n, 3) unit axes of the arcs, NaN for lines.
        length: (n,) mm; zeros in a program without G93, where they are unused.
    """

    motions: Motions
    arc_centre: Array
    arc_axis: Array
    length: Array


def _path(
    blocks: Blocks, modal: Modal, tracker: PositionTracker, lost: Array, options: ReadOptions, faults: BlockDiagnostics
) -> _Path | None:
    """The path of a program, or None with the faults added that prevent it."""
    motions = tracker.motions()
    checkpoint()
    _check_unknown_positions(motions, lost, faults)
    check_unknown_positions_after_turns(blocks, motions, faults)
    centre, axis = arc_geometry(blocks, modal, motions, faults)
    if faults.has_errors():
        return None
    motions, centre, axis = split_turns(blocks, modal, motions, centre, axis)
    checkpoint()
    length = path_lengths(motions, centre, axis) if _uses_inverse_time(modal) else uniform(0.0, len(motions))
    first = motions.block[:1].tolist()
    motions, columns = with_known_ends(motions, [centre, axis, length])
    if not len(motions) and options.needs_motion:
        _report_no_motion(blocks, first, tracker.known, faults)
        return None
    return _Path(motions, *columns)


def _columns(
    blocks: Blocks, modal: Modal, states: BlockStates, path: _Path, options: ReadOptions, faults: BlockDiagnostics
) -> dict[str, Array]:
    """Columns of the program, in {C}."""
    motions = path.motions
    frames = RowFrames.of(motions.frames, motions.frame)
    tool_axis = axes_in_work_frame(motions, states.axes, states.written, states.spins, options, faults)
    side, plane = _compensation(blocks, modal, motions, frames, states.sides, tool_axis, faults)
    angle = uniform(0.0, len(motions))
    if _uses_inverse_time(modal):
        angle = np.degrees(np.append(0.0, angle_between(tool_axis[:-1], tool_axis[1:])))
    return {
        "tool_axis": tool_axis,
        "kind": _KIND[motions.motion],
        "position": frames.points(motions.end),
        "feed": feeds(blocks, modal, states.spindle, motions, path.length, angle, options, faults),
        "arc_centre": frames.points(path.arc_centre),
        "arc_axis": _mirrored(frames.hand(), frames.directions(path.arc_axis)),
        "side_offset": side,
        "plane": plane,
        "normal": frames.directions(motions.of_blocks(states.normals)),
        "spin": motions.of_blocks(states.spins),
        "operation": uniform(0, len(motions), np.int32),
        "line": motions.of_blocks(blocks.line),
    }


def _check_unknown_positions(motions: Motions, lost: Array, faults: BlockDiagnostics) -> None:
    """Report cuts to positions still unknown after a turn of the tool without tip control."""
    if not lost.any():
        return
    first = int(np.flatnonzero(lost)[0])
    for block in distinct(motions.block[~motions.known & (motions.motion != 0) & (motions.block > first)]).tolist():
        faults.add("G416", block, "a cut after the tool was turned without control of its tip")


def _uses_inverse_time(modal: Modal) -> bool:
    """Whether a program has G93, which alone needs lengths and angles of the motions."""
    return bool((modal.active[Group.FEED_MODE] == INVERSE_TIME).any())


def _mirrored(hand: Array, column: Array) -> Array:
    """Arc axes in {C}, (n, 3): a mirrored frame inverts their sense."""
    return column if is_uniform(column) or (hand > 0).all() else hand[:, None] * column


def _compensation(
    blocks: Blocks,
    modal: Modal,
    motions: Motions,
    frames: RowFrames,
    sides: Array,
    tool_axis: Array,
    faults: BlockDiagnostics,
) -> tuple[Array, Array]:
    """Side offset and plane of each motion in {C}, (n,) each: a mirror changes the side."""
    coordinate = map_rows(normal_coordinate, motions.of_blocks(modal.active[Group.PLANE]))
    plane, along = frames.planes(coordinate)
    side = motions.of_blocks(sides)
    if not side.any():
        return side, plane
    turned = np.flatnonzero((side != 0) & (np.abs(along) < _ALONG_AN_AXIS))
    normal = frames.turn[frames.frame[turned], :, coordinate[turned]]
    oblique = np.zeros(len(blocks), dtype=np.bool_)
    oblique[motions.block[turned[np.abs(dot(normal, tool_axis[turned])) < _ALONG_AN_AXIS]]] = True
    faults.add_where("G419", oblique, "the plane is turned out of X, Y and Z")
    return side * np.sign(along) * frames.hand(), plane


def _tools(numbers: Array, options: ReadOptions) -> dict[int, Tool]:
    """The tools in use, by number."""
    called = [number for number in distinct(numbers).tolist() if number != NONE]
    tools = {number: replace(tool, number=number) for number in called if (tool := options.tool(number))}
    initial = options.tool(0)
    return {initial.number: initial} if initial and not tools else tools
