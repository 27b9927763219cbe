/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * The records of a trajectory file (.pkmt), version 1.1, and the pose within a segment. The meaning of every field is
 * in docs/trajectory-format.md. The file is little-endian, its records have no gaps, and a table begins at a multiple of
 * 8 bytes: on a machine with little-endian numbers they are read where they lie, also from a mapped file.
 * tests/trajectory_file/read_trajectory.c shows how.
 */
#ifndef PKMT_H
#define PKMT_H

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "the records of a trajectory file are little-endian"
#endif

#define PKMT_MAGIC "PKMT\r\n\x1a\n"
#define PKMT_MAJOR 1 /* refuse a file with another one */
#define PKMT_MINOR 1 /* a file with a newer one can be read without what it adds */

#define PKMT_AT(record, field, place) static_assert(offsetof(struct pkmt_##record, field) == (place), #field)
#define PKMT_SIZE(record, size) static_assert(sizeof(struct pkmt_##record) == (size), #record)

enum pkmt_segment_kind { PKMT_RAPID = 0, PKMT_LINE = 1, PKMT_ARC = 2 };

enum pkmt_instruction_kind {
    PKMT_TOOL_CHANGE = 1,
    PKMT_SPINDLE = 2,
    PKMT_COOLANT = 3,
    PKMT_DWELL = 4,
    PKMT_STOP = 5,
    PKMT_FUNCTION = 6,
    PKMT_SPINDLE_AXIS = 7
};

/* A string: UTF-8 without an end mark, counted from the beginning of the text table. */
struct pkmt_string {
    uint64_t offset;                        /* byte */
    uint64_t length;                        /* byte */
};
PKMT_AT(string, offset, 0);
PKMT_AT(string, length, 8);
PKMT_SIZE(string, 16);

/* A table: its place in the file. A newer minor version may have longer records: step by record_size. */
struct pkmt_table {
    uint64_t offset;                        /* byte, from the beginning of the file */
    uint64_t count;
    uint64_t record_size;
};
PKMT_AT(table, offset, 0);
PKMT_AT(table, count, 8);
PKMT_AT(table, record_size, 16);
PKMT_SIZE(table, 24);

/* The beginning of the file. */
struct pkmt_header {
    char magic[8];                          /* PKMT \r \n 0x1a \n */
    uint16_t major;
    uint16_t minor;
    uint32_t header_size;
    uint64_t file_size;
    uint32_t header_crc;                    /* CRC-32 of the header, with these four bytes as 0 */
    uint32_t body_crc;                      /* CRC-32 of all bytes behind the header */
    struct pkmt_table segments;
    struct pkmt_table blocks;
    struct pkmt_table instructions;
    struct pkmt_table tools;
    struct pkmt_table operations;
    struct pkmt_table text;                 /* its records are bytes */
    struct pkmt_string machine;
    struct pkmt_string source;
    uint8_t machine_fingerprint[32];        /* SHA-256 of the machine file */
    uint8_t source_fingerprint[32];         /* SHA-256 of the source, or 0 */
    double length_unit;                     /* m: 0.001 */
    double angle_unit;                      /* rad: 1 */
    double time_unit;                       /* s: 1 */
    double tip_tolerance;                   /* mm, or 0 */
    double axis_tolerance;                  /* rad, or 0 */
    double machine_from_work[4][4];         /* mm, row by row */
    double start_tip[3];                    /* mm */
    double start_axis[3];                   /* unit vector */
    double start_spin;                      /* rad */
    uint8_t reserved[16];
};
PKMT_AT(header, magic, 0);
PKMT_AT(header, major, 8);
PKMT_AT(header, minor, 10);
PKMT_AT(header, header_size, 12);
PKMT_AT(header, file_size, 16);
PKMT_AT(header, header_crc, 24);
PKMT_AT(header, body_crc, 28);
PKMT_AT(header, segments, 32);
PKMT_AT(header, blocks, 56);
PKMT_AT(header, instructions, 80);
PKMT_AT(header, tools, 104);
PKMT_AT(header, operations, 128);
PKMT_AT(header, text, 152);
PKMT_AT(header, machine, 176);
PKMT_AT(header, source, 192);
PKMT_AT(header, machine_fingerprint, 208);
PKMT_AT(header, source_fingerprint, 240);
PKMT_AT(header, length_unit, 272);
PKMT_AT(header, angle_unit, 280);
PKMT_AT(header, time_unit, 288);
PKMT_AT(header, tip_tolerance, 296);
PKMT_AT(header, axis_tolerance, 304);
PKMT_AT(header, machine_from_work, 312);
PKMT_AT(header, start_tip, 440);
PKMT_AT(header, start_axis, 464);
PKMT_AT(header, start_spin, 488);
PKMT_AT(header, reserved, 496);
PKMT_SIZE(header, 512);

/* A tool, with the gauge length that the trajectory was made for. */
struct pkmt_tool {
    int32_t number;
    uint32_t reserved;
    struct pkmt_string name;
    double diameter;                        /* mm, 0 when unknown */
    double corner_radius;                   /* mm */
    double length;                          /* mm, from the spindle nose to the tip */
    double bottom_angle;                    /* rad, rise of the bottom */
    double side_angle;                      /* rad, of the side to the axis */
};
PKMT_AT(tool, number, 0);
PKMT_AT(tool, reserved, 4);
PKMT_AT(tool, name, 8);
PKMT_AT(tool, diameter, 24);
PKMT_AT(tool, corner_radius, 32);
PKMT_AT(tool, length, 40);
PKMT_AT(tool, bottom_angle, 48);
PKMT_AT(tool, side_angle, 56);
PKMT_SIZE(tool, 64);

/* An operation of the CAM job. */
struct pkmt_operation {
    struct pkmt_string name;
};
PKMT_AT(operation, name, 0);
PKMT_SIZE(operation, 16);

/* An auxiliary instruction: takes place before the segment `row`, with the machine at rest. */
struct pkmt_instruction {
    uint64_t row;
    uint32_t kind;                          /* enum pkmt_instruction_kind */
    uint32_t reserved;
    double value;                           /* tool number; 1/min; 0, 1, 2; s; 0, 1 */
};
PKMT_AT(instruction, row, 0);
PKMT_AT(instruction, kind, 8);
PKMT_AT(instruction, reserved, 12);
PKMT_AT(instruction, value, 16);
PKMT_SIZE(instruction, 24);

/* A motion instruction. It holds all that its poses need. */
struct pkmt_segment {
    double tip[3];                          /* mm, at the end */
    double axis[3];                         /* unit vector, at the end */
    double feed;                            /* mm/s */
    double length;                          /* mm, of the way of the tip */
    double spin;                            /* rad, at the end */
    double arc_centre[3];                   /* mm, or NaN */
    double arc_axis[3];                     /* unit vector, or NaN */
    double sweep;                           /* rad, or 0 */
    double angle;                           /* rad, of the turn of the axis */
    double start_tip[3];                    /* mm */
    double start_axis[3];                   /* unit vector */
    double start_spin;                      /* rad */
    double shift[3];                        /* mm, straight part of the way */
    double radius[3];                       /* mm, or 0 */
    double quarter[3];                      /* mm, or 0 */
    double growth;                          /* of the radius, or 0 */
    double axis_quarter[3];                 /* unit vector, or 0 */
    int32_t tool;
    int32_t operation;                      /* index into the operations */
    int32_t line;
    uint8_t kind;                           /* enum pkmt_segment_kind */
    uint8_t smooth;                         /* 0 or 1 */
    uint8_t exact_stop;                     /* 0 or 1 */
    uint8_t reserved;
    double tip_tolerance;                   /* mm, or 0 for that of the header; since 1.1 */
};
PKMT_AT(segment, tip, 0);
PKMT_AT(segment, axis, 24);
PKMT_AT(segment, feed, 48);
PKMT_AT(segment, length, 56);
PKMT_AT(segment, spin, 64);
PKMT_AT(segment, arc_centre, 72);
PKMT_AT(segment, arc_axis, 96);
PKMT_AT(segment, sweep, 120);
PKMT_AT(segment, angle, 128);
PKMT_AT(segment, start_tip, 136);
PKMT_AT(segment, start_axis, 160);
PKMT_AT(segment, start_spin, 184);
PKMT_AT(segment, shift, 192);
PKMT_AT(segment, radius, 216);
PKMT_AT(segment, quarter, 240);
PKMT_AT(segment, growth, 264);
PKMT_AT(segment, axis_quarter, 272);
PKMT_AT(segment, tool, 296);
PKMT_AT(segment, operation, 300);
PKMT_AT(segment, line, 304);
PKMT_AT(segment, kind, 308);
PKMT_AT(segment, smooth, 309);
PKMT_AT(segment, exact_stop, 310);
PKMT_AT(segment, reserved, 311);
PKMT_AT(segment, tip_tolerance, 312);
PKMT_SIZE(segment, 320);

/* The first segment that a line of the source makes; sorted by operation and line. */
struct pkmt_block {
    int32_t operation;                      /* index into the operations */
    int32_t line;
    uint64_t segment;                       /* index into the segments */
};
PKMT_AT(block, operation, 0);
PKMT_AT(block, line, 4);
PKMT_AT(block, segment, 8);
PKMT_SIZE(block, 16);
struct pkmt_pose {
    double tip[3];  /* mm */
    double axis[3]; /* unit vector */
    double spin;    /* rad */
};

/* The pose at a share of a segment, from 0 at its start to 1 at its end. */
static inline struct pkmt_pose pkmt_pose_at(const struct pkmt_segment *segment, double share)
{
    const double turned = share * segment->sweep, tilted = share * segment->angle;
    const double scale = 1.0 + share * segment->growth;
    const double along = scale * cos(turned) - 1.0, across = scale * sin(turned);
    const double kept = cos(tilted), gained = sin(tilted);
    struct pkmt_pose pose;
    int i;

    for (i = 0; i < 3; i++) {
        pose.tip[i] = segment->start_tip[i] + share * segment->shift[i] + along * segment->radius[i] +
                      across * segment->quarter[i];
        pose.axis[i] = kept * segment->start_axis[i] + gained * segment->axis_quarter[i];
    }
    pose.spin = segment->start_spin + share * (segment->spin - segment->start_spin);
    return pose;
}

#endif
