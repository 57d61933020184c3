/* Counts the allocations of the library: as it is prepared, and while it plays so many frames, with
 * wishes of each kind between the blocks. Prints both counts, the frames, and one of its own.
 *
 *     allocate FRAMES KINDS
 */
#include <stdio.h>
#include <stdlib.h>

#include "counted.h"
#include "yehu.h"

#define BLOCK 128

int main(int count, char **words) {
    if (count != 3) return 2;
    long frames = atol(words[1]), kinds = atol(words[2]), counted = allocations();
    void *yehu = aligned_alloc(64, (yehu_size() + 63) / 64 * 64);
    float out[2 * BLOCK];
    long own = allocations() - counted; /* it does count */
    struct yehu_look seen;
    if (!yehu) return 3;
    counted = allocations();
    if (!yehu_prepare(yehu, 48000.0, 2)) return 4;
    long preparing = allocations() - counted;
    counted = allocations();
    for (long done = 0; done < frames; done += BLOCK) {
        long wish = done / BLOCK;
        yehu_post(yehu, done, YEHU_BEGIN, 0, 65.0 + wish % 24, 65.0 + wish % 24);
        yehu_post(yehu, done, wish % kinds, wish % 40, 0.1 * (wish % 9), 0.2);
        yehu_process(yehu, out, BLOCK);
        yehu_look(yehu, &seen);
        yehu_value(yehu, wish % 40);
        yehu_pitch(yehu);
    }
    long playing = allocations() - counted;
    printf("%ld %ld %ld %ld\n", own, preparing, playing, (long)yehu_frame(yehu));
    free(yehu);
    return 0;
}
