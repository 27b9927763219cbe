# SPDX-License-Identifier: LGPL-2.1-or-later
# `make conformance` compiles this, and reads a file with what comes out. A Kaitai Struct cannot check the checksums.
meta:
  id: pkmt
  title: Trajectory file of PKM Post, version 1.1
  file-extension: pkmt
  license: LGPL-2.1-or-later
  endian: le
doc: |
  Lines and arcs of a tool tip on a hexapod machine tool, with the tool axis and the spin of the platform.
  docs/trajectory-format.md has the meaning of every field.
seq:
  - id: header
    type: header
instances:
  segments:
    pos: header.segments.offset
    type: segment
    size: header.segments.record_size
    repeat: expr
    repeat-expr: header.segments.count
  blocks:
    pos: header.blocks.offset
    type: block
    size: header.blocks.record_size
    repeat: expr
    repeat-expr: header.blocks.count
  instructions:
    pos: header.instructions.offset
    type: instruction
    size: header.instructions.record_size
    repeat: expr
    repeat-expr: header.instructions.count
  tools:
    pos: header.tools.offset
    type: tool
    size: header.tools.record_size
    repeat: expr
    repeat-expr: header.tools.count
  operations:
    pos: header.operations.offset
    type: operation
    size: header.operations.record_size
    repeat: expr
    repeat-expr: header.operations.count
types:
  string:
    doc: "A string: UTF-8 without an end mark, counted from the beginning of the text table. 16 bytes."
    seq:
      - id: offset
        type: u8
        doc: "byte"
      - id: length
        type: u8
        doc: "byte"
    instances:
      value:
        io: _root._io
        pos: _root.header.text.offset + offset
        type: str
        size: length
        encoding: UTF-8
  table:
    doc: "A table: its place in the file. A newer minor version may have longer records: step by record_size. 24 bytes."
    seq:
      - id: offset
        type: u8
        doc: "byte, from the beginning of the file"
      - id: count
        type: u8
      - id: record_size
        type: u8
  header:
    doc: "The beginning of the file. 512 bytes."
    seq:
      - id: magic
        contents: [0x50, 0x4b, 0x4d, 0x54, 0x0d, 0x0a, 0x1a, 0x0a]
        doc: PKMT and the four bytes of line ends
      - id: major
        type: u2
        valid: 1
      - id: minor
        type: u2
      - id: header_size
        type: u4
      - id: file_size
        type: u8
      - id: header_crc
        type: u4
        doc: "CRC-32 of the header, with these four bytes as 0"
      - id: body_crc
        type: u4
        doc: "CRC-32 of all bytes behind the header"
      - id: segments
        type: table
      - id: blocks
        type: table
      - id: instructions
        type: table
      - id: tools
        type: table
      - id: operations
        type: table
      - id: text
        type: table
        doc: "its records are bytes"
      - id: machine
        type: string
      - id: source
        type: string
      - id: machine_fingerprint
        size: 32
        doc: "SHA-256 of the machine file"
      - id: source_fingerprint
        size: 32
        doc: "SHA-256 of the source, or 0"
      - id: length_unit
        type: f8
        doc: "m: 0.001"
      - id: angle_unit
        type: f8
        doc: "rad: 1"
      - id: time_unit
        type: f8
        doc: "s: 1"
      - id: tip_tolerance
        type: f8
        doc: "mm, or 0"
      - id: axis_tolerance
        type: f8
        doc: "rad, or 0"
      - id: machine_from_work
        type: f8
        repeat: expr
        repeat-expr: 16
        doc: "mm, row by row"
      - id: start_tip
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "mm"
      - id: start_axis
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "unit vector"
      - id: start_spin
        type: f8
        doc: "rad"
      - id: reserved
        size: 16
  tool:
    doc: "A tool, with the gauge length that the trajectory was made for. 64 bytes."
    seq:
      - id: number
        type: s4
      - id: reserved
        type: u4
      - id: name
        type: string
      - id: diameter
        type: f8
        doc: "mm, 0 when unknown"
      - id: corner_radius
        type: f8
        doc: "mm"
      - id: length
        type: f8
        doc: "mm, from the spindle nose to the tip"
      - id: bottom_angle
        type: f8
        doc: "rad, rise of the bottom"
      - id: side_angle
        type: f8
        doc: "rad, of the side to the axis"
  operation:
    doc: "An operation of the CAM job. 16 bytes."
    seq:
      - id: name
        type: string
  instruction:
    doc: "An auxiliary instruction: takes place before the segment `row`, with the machine at rest. 24 bytes."
    seq:
      - id: row
        type: u8
      - id: kind
        type: u4
        enum: instruction_kind
        valid:
          in-enum: true
      - id: reserved
        type: u4
      - id: value
        type: f8
        doc: "tool number; 1/min; 0, 1, 2; s; 0, 1"
  segment:
    doc: "A motion instruction. It holds all that its poses need. 320 bytes."
    seq:
      - id: tip
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "mm, at the end"
      - id: axis
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "unit vector, at the end"
      - id: feed
        type: f8
        doc: "mm/s"
      - id: length
        type: f8
        doc: "mm, of the way of the tip"
      - id: spin
        type: f8
        doc: "rad, at the end"
      - id: arc_centre
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "mm, or NaN"
      - id: arc_axis
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "unit vector, or NaN"
      - id: sweep
        type: f8
        doc: "rad, or 0"
      - id: angle
        type: f8
        doc: "rad, of the turn of the axis"
      - id: start_tip
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "mm"
      - id: start_axis
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "unit vector"
      - id: start_spin
        type: f8
        doc: "rad"
      - id: shift
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "mm, straight part of the way"
      - id: radius
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "mm, or 0"
      - id: quarter
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "mm, or 0"
      - id: growth
        type: f8
        doc: "of the radius, or 0"
      - id: axis_quarter
        type: f8
        repeat: expr
        repeat-expr: 3
        doc: "unit vector, or 0"
      - id: tool
        type: s4
      - id: operation
        type: s4
        doc: "index into the operations"
      - id: line
        type: s4
      - id: kind
        type: u1
        enum: segment_kind
        valid:
          in-enum: true
      - id: smooth
        type: u1
        doc: "0 or 1"
      - id: exact_stop
        type: u1
        doc: "0 or 1"
      - id: reserved
        type: u1
      - id: tip_tolerance
        type: f8
        doc: "mm, or 0 for that of the header; since 1.1"
  block:
    doc: "The first segment that a line of the source makes; sorted by operation and line. 16 bytes."
    seq:
      - id: operation
        type: s4
        doc: "index into the operations"
      - id: line
        type: s4
      - id: segment
        type: u8
        doc: "index into the segments"
enums:
  segment_kind:
    0: rapid
    1: line
    2: arc
  instruction_kind:
    1: tool_change
    2: spindle
    3: coolant
    4: dwell
    5: stop
    6: function
    7: spindle_axis
