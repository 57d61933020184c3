/* Plays steps by the library, for the tests, and writes the memory of the instrument at the end.
 *
 *     streams STEPS TABLES BLOCKS REPORTING MEMORY
 *
 * STEPS has lines: the name of a function, its frame and arguments; "map" takes the next of TABLES.
 * REPORTING is the number of the word of memory that lets commands be reported. What was not taken
 * ends it with 10 and the number of the line.
 */
#include <stdio.h>
#include <stdlib.h>

#include "yehu.h"

#define BLOCK 128
#define MOST 4096

static struct yehu_tables tables;
static uint8_t bytes[MOST];
static float out[2 * BLOCK];

/* Reads the rest of a line and does it: 1 where it was taken. */
static int step(void *yehu, const char *name, int64_t frame, FILE *steps, FILE *all_tables) {
    long long kind, index, n;
    double value, other;
    if (*name == 'm' && name[1] == 'a') {
        if (fscanf(steps, "%lld", &n) != 1) return 0;
        if (fread(&tables, sizeof tables, 1, all_tables) != 1) return 0;
        return yehu_use_tables(yehu, frame, &tables, sizeof tables) == 1;
    }
    if (*name == 'm') {
        if (fscanf(steps, "%lld", &n) != 1 || n > MOST) return 0;
        for (long i = 0; i < n; i++)
            if (fscanf(steps, "%hhu", &bytes[i]) != 1) return 0;
        return yehu_midi(yehu, frame, bytes, n) >= 0;
    }
    if (*name == 'c')
        return fscanf(steps, "%lld %lf", &index, &value) == 2 &&
               yehu_control(yehu, frame, index, value);
    return fscanf(steps, "%lld %lld %lf %lf", &kind, &index, &value, &other) == 4 &&
           yehu_post(yehu, frame, kind, index, value, other);
}

int main(int count, char **words) {
    if (count != 6) return 2;
    FILE *steps = fopen(words[1], "r"), *all_tables = fopen(words[2], "rb");
    FILE *memory = fopen(words[5], "wb");
    long blocks = atol(words[3]), line = 0;
    void *yehu = aligned_alloc(64, (yehu_size() + 63) / 64 * 64);
    if (!steps || !all_tables || !memory || !yehu) return 3;
    if (!yehu_prepare(yehu, 48000.0, 2)) return 4;
    ((int64_t *)yehu)[atol(words[4])] = 1;
    char name[16];
    long long frame;
    int waits = fscanf(steps, "%15s %lld", name, &frame) == 2;
    for (long block = 0; block < blocks; block++) {
        while (waits && frame < (block + 1) * BLOCK) {
            line++;
            if (!step(yehu, name, frame, steps, all_tables)) {
                fprintf(stderr, "line %ld\n", line);
                return 10;
            }
            waits = fscanf(steps, "%15s %lld", name, &frame) == 2;
        }
        yehu_process(yehu, out, BLOCK);
    }
    fwrite(yehu, 1, yehu_size(), memory);
    return fclose(memory) ? 5 : 0;
}
