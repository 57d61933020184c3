/* Counts the allocations of the library: as it is prepared, and while it plays so many frames, with
 * events of each kind, MIDI and mappings between the blocks. Prints one count of its own, those two,
 * the frames, and how often the tables in a file were taken.
 *
 *     allocate FRAMES KINDS TABLES
 */
#include <stdio.h>
#include <stdlib.h>

#include "counted.h"
#include "yehu.h"

#define BLOCK 128

static struct yehu_tables tables;

int main(int count, char **words) {
    if (count != 4) return 2;
    FILE *file = fopen(words[3], "rb");
    if (!file || fread(&tables, sizeof tables, 1, file) != 1) return 6;
    long frames = atol(words[1]), kinds = atol(words[2]), counted = allocations();
    void *yehu = aligned_alloc(64, (yehu_size() + 63) / 64 * 64);
    float out[2 * BLOCK];
    long own = allocations() - counted; /* it does count */
    long taken = 0;
    struct yehu_snapshot seen;
    if (!yehu) return 3;
    counted = allocations();
    if (!yehu_prepare(yehu, 48000.0, 2)) return 4;
    long preparing = allocations() - counted;
    counted = allocations();
    for (long done = 0; done < frames; done += BLOCK) {
        long command = done / BLOCK;
        yehu_post(yehu, done, YEHU_BEGIN, 0, 65.0 + command % 24, 65.0 + command % 24);
        yehu_post(yehu, done, command % kinds, command % 40, 0.1 * (command % 9), 0.2);
        uint8_t bytes[] = {0x90, 65 + command % 24, 90, 0xB0, 1, command % 128};
        yehu_midi(yehu, done, bytes, sizeof bytes);
        yehu_control(yehu, done, command % 3, 0.5);
        taken += yehu_use_tables(yehu, done, &tables, sizeof tables) == 1;
        yehu_process(yehu, out, BLOCK);
        yehu_snapshot(yehu, &seen);
        yehu_value(yehu, command % 40);
        yehu_pitch(yehu);
    }
    long playing = allocations() - counted;
    printf("%ld %ld %ld %ld %ld\n", own, preparing, playing, (long)yehu_frame(yehu), taken);
    free(yehu);
    return 0;
}
