/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * Maps a trajectory file and prints the seconds of the processor that two ways through all segments took, mapping
 * included: looking at each (time at its feed, end of the tip), and the pose in the middle of each. For
 * benchmarks/trajectory_file.py.
 */
#define _POSIX_C_SOURCE 200809L
#include "pkmt.h"
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double look(const struct pkmt_segment *segment)
{
    return segment->length / segment->feed + segment->tip[0] * segment->tip[1] * segment->tip[2];
}

static double middle(const struct pkmt_segment *segment)
{
    const struct pkmt_pose pose = pkmt_pose_at(segment, 0.5);
    return pose.tip[0] + pose.axis[0] + pose.spin;
}

/* Seconds from opening the file to the end of the walk; the sum is handed out so that no step can be left out. */
static double walk(const char *path, double (*visit)(const struct pkmt_segment *), double *sum)
{
    const double start = seconds();
    const int file = open(path, O_RDONLY);
    struct stat about;
    if (file < 0 || fstat(file, &about))
        return -1;
    const unsigned char *content = mmap(NULL, (size_t)about.st_size, PROT_READ, MAP_PRIVATE, file, 0);
    if (content == MAP_FAILED)
        return -1;
    const struct pkmt_header *header = (const void *)content;
    if (memcmp(header->magic, PKMT_MAGIC, 8) || header->major != PKMT_MAJOR)
        return -1;
    const unsigned char *record = content + header->segments.offset;
    for (uint64_t i = 0; i < header->segments.count; i++, record += header->segments.record_size)
        *sum += visit((const void *)record);
    munmap((void *)content, (size_t)about.st_size);
    close(file);
    return seconds() - start;
}

int main(int count, char **arguments)
{
    double sum = 0;
    if (count != 2)
        return 1;
    const double looked = walk(arguments[1], look, &sum), played = walk(arguments[1], middle, &sum);
    printf("%.6f %.6f %g\n", looked, played, sum);
    return looked < 0 || played < 0;
}
