/* Plays commands by the library, for the tests: reads "frame kind index value other" lines, and writes
 * samples (float32), those of all channels of a frame after one another.
 *
 *     play RATE CHANNELS FRAMES BLOCK COMMANDS SAMPLES
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "yehu.h"

int main(int count, char **words) {
    if (count != 7) return 2;
    double rate = atof(words[1]);
    long channels = atol(words[2]), frames = atol(words[3]), block = atol(words[4]);
    void *yehu = aligned_alloc(64, (yehu_size() + 63) / 64 * 64);
    float *out = malloc(block * channels * sizeof *out);
    FILE *commands = fopen(words[5], "r"), *samples = fopen(words[6], "wb");
    if (!yehu || !out || !commands || !samples) return 3;
    memset(yehu, 255, yehu_size()); /* preparing relies on nothing */
    if (!yehu_prepare(yehu, rate, channels)) {
        fprintf(stderr, "no instrument at %g Hz\n", rate);
        return 4;
    }
    long long frame, kind, index;
    double value, other;
    while (fscanf(commands, "%lld %lld %lld %lf %lf", &frame, &kind, &index, &value, &other) == 5)
        if (!yehu_post(yehu, frame, kind, index, value, other)) return 5;
    for (long done = 0; done < frames; done += block) {
        long now = frames - done < block ? frames - done : block;
        yehu_process(yehu, out, now);
        fwrite(out, channels * sizeof *out, now, samples);
    }
    struct yehu_snapshot seen;
    yehu_snapshot(yehu, &seen);
    printf("%llx %lld %lld %.17g %.17g\n", (unsigned long long)yehu_sources(),
           (long long)yehu_frame(yehu), (long long)yehu_lost(yehu), seen.rate,
           yehu_value(yehu, YEHU_PLAYING_BOW_POSITION));
    return fclose(samples) ? 6 : 0;
}
