/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * Reads a trajectory file and prints every field of it, a record by line, and the pose in the middle of each segment.
 *
 *     cc -std=c11 -I resources/trajectory tests/writing/trajectory_file/read_trajectory.c -o read_trajectory -lm
 *     ./read_trajectory part.pkmt [OPERATION LINE]
 *
 * With an operation and a line of it, prints only the first segment that comes from there or from behind it.
 */
#include "pkmt.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const unsigned char *content;
static const struct pkmt_header *header;

static void refuse(const char *reason)
{
    fprintf(stderr, "not read: %s\n", reason);
    exit(1);
}

static uint32_t crc32(uint32_t crc, const unsigned char *bytes, size_t size)
{
    for (crc = ~crc; size--; bytes++) {
        crc ^= *bytes;
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
    }
    return ~crc;
}

static void check_table(const struct pkmt_table *table, size_t record, size_t size)
{
    if (table->record_size < record || table->record_size > size || (record > 1 && table->record_size % 8) ||
        table->offset > size || table->offset % 8 || table->count > (size - table->offset) / table->record_size)
        refuse("a table does not fit the file");
}

static void open_file(const char *path)
{
    static const unsigned char zeros[4];
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END))
        refuse("the file cannot be opened");
    const long size = ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(size > 0 ? (size_t)size : 1);
    if (size < (long)sizeof *header || !bytes || fread(bytes, 1, (size_t)size, file) != (size_t)size)
        refuse("the file is too short");
    fclose(file);
    content = bytes, header = (const void *)bytes;
    if (memcmp(header->magic, PKMT_MAGIC, sizeof header->magic) || header->major != PKMT_MAJOR)
        refuse("another kind of file, or another version");
    if (header->file_size != (uint64_t)size || header->header_size < sizeof *header || header->header_size > (size_t)size)
        refuse("the size is wrong");
    const size_t sum = offsetof(struct pkmt_header, header_crc), behind = sum + sizeof zeros;
    const uint32_t crc = crc32(crc32(0, content, sum), zeros, sizeof zeros);
    if (crc32(crc, content + behind, header->header_size - behind) != header->header_crc ||
        crc32(0, content + header->header_size, (size_t)size - header->header_size) != header->body_crc)
        refuse("a checksum is wrong");
    check_table(&header->tools, sizeof(struct pkmt_tool), (size_t)size);
    check_table(&header->operations, sizeof(struct pkmt_operation), (size_t)size);
    check_table(&header->instructions, sizeof(struct pkmt_instruction), (size_t)size);
    check_table(&header->segments, sizeof(struct pkmt_segment), (size_t)size);
    check_table(&header->blocks, sizeof(struct pkmt_block), (size_t)size);
    check_table(&header->text, 1, (size_t)size);
}

static const void *record(const struct pkmt_table *table, uint64_t index)
{
    return content + table->offset + index * table->record_size;
}

static void print_string(const char *name, const struct pkmt_string *string)
{
    if (string->offset > header->text.count || string->length > header->text.count - string->offset)
        refuse("a string lies beyond the text");
    printf(" %s ", name);
    for (uint64_t i = 0; i < string->length; i++)
        printf("%02x", content[header->text.offset + string->offset + i]);
}

static void print_reals(const char *name, const double *values, size_t count)
{
    printf(" %s", name);
    for (size_t i = 0; i < count; i++)
        isnan(values[i]) ? printf(" nan") : printf(" %.17g", values[i]);
}

static void print_bytes(const char *name, const unsigned char *bytes, size_t size)
{
    printf(" %s ", name);
    while (size--)
        printf("%02x", *bytes++);
}

#define STRING(of, field) print_string(#field, &(of)->field)
#define REALS(of, field) print_reals(#field, (const double *)&(of)->field, sizeof (of)->field / sizeof(double))
#define BYTES(of, field) print_bytes(#field, (const unsigned char *)&(of)->field, sizeof (of)->field)
#define INTEGER(of, field) printf(" %s %" PRId64, #field, (int64_t)(of)->field)
#define TABLE(of, field) INTEGER(of, field.offset), INTEGER(of, field.count), INTEGER(of, field.record_size)
#define EACH(table, print) \
    for (uint64_t each = 0; each < header->table.count; each++) \
        print(record(&header->table, each))

static void print_header(const struct pkmt_header *h)
{
    printf("header");
    BYTES(h, magic), INTEGER(h, major), INTEGER(h, minor), INTEGER(h, header_size), INTEGER(h, file_size);
    INTEGER(h, header_crc), INTEGER(h, body_crc), TABLE(h, segments), TABLE(h, blocks), TABLE(h, instructions);
    TABLE(h, tools), TABLE(h, operations), TABLE(h, text), STRING(h, machine), STRING(h, source);
    BYTES(h, machine_fingerprint), BYTES(h, source_fingerprint);
    REALS(h, length_unit), REALS(h, angle_unit), REALS(h, time_unit), REALS(h, tip_tolerance), REALS(h, axis_tolerance);
    REALS(h, machine_from_work), REALS(h, start_tip), REALS(h, start_axis), REALS(h, start_spin), BYTES(h, reserved);
}

static void print_tool(const struct pkmt_tool *t)
{
    printf("\ntools");
    INTEGER(t, number), INTEGER(t, reserved), STRING(t, name), REALS(t, diameter), REALS(t, corner_radius);
    REALS(t, length), REALS(t, bottom_angle), REALS(t, side_angle);
}

static void print_operation(const struct pkmt_operation *o)
{
    printf("\noperations"), STRING(o, name);
}

static void print_instruction(const struct pkmt_instruction *i)
{
    printf("\ninstructions"), INTEGER(i, row), INTEGER(i, kind), INTEGER(i, reserved), REALS(i, value);
}

static void print_block(const struct pkmt_block *b)
{
    printf("\nblocks"), INTEGER(b, operation), INTEGER(b, line), INTEGER(b, segment);
}

static void print_segment(const struct pkmt_segment *s)
{
    const struct pkmt_pose middle = pkmt_pose_at(s, 0.5);
    printf("\nsegments");
    REALS(s, tip), REALS(s, axis), REALS(s, feed), REALS(s, length), REALS(s, spin), REALS(s, arc_centre);
    REALS(s, arc_axis), REALS(s, sweep), REALS(s, angle), REALS(s, start_tip), REALS(s, start_axis), REALS(s, start_spin);
    REALS(s, shift), REALS(s, radius), REALS(s, quarter), REALS(s, growth), REALS(s, axis_quarter);
    INTEGER(s, tool), INTEGER(s, operation), INTEGER(s, line);
    INTEGER(s, kind), INTEGER(s, smooth), INTEGER(s, exact_stop), INTEGER(s, reserved), REALS(s, tip_tolerance);
    printf("\nmiddle");
    REALS(&middle, tip), REALS(&middle, axis), REALS(&middle, spin);
}

/* The first segment of a line, or of the first line behind it; the number of segments when there is none. */
static uint64_t segment_of(int32_t operation, int32_t line)
{
    uint64_t low = 0, high = header->blocks.count;
    while (low < high) {
        const uint64_t middle = low + (high - low) / 2;
        const struct pkmt_block *block = record(&header->blocks, middle);
        if (block->operation < operation || (block->operation == operation && block->line < line))
            low = middle + 1;
        else
            high = middle;
    }
    return low < header->blocks.count ? ((const struct pkmt_block *)record(&header->blocks, low))->segment
                                      : header->segments.count;
}

int main(int count, char **arguments)
{
    if (count != 2 && count != 4)
        refuse("give the name of a trajectory file, or that with an operation and a line");
    open_file(arguments[1]);
    if (count == 4) {
        printf("%" PRIu64 "\n", segment_of(atoi(arguments[2]), atoi(arguments[3])));
        return 0;
    }
    print_header(header);
    EACH(segments, print_segment);
    EACH(blocks, print_block);
    EACH(instructions, print_instruction);
    EACH(tools, print_tool);
    EACH(operations, print_operation);
    printf("\n");
    return 0;
}
