/* Plays random bytes as MIDI messages of all ports by the library, through random mappings, and ends
 * all notes now and then. Prints how many messages were posted, tables taken and refused, wrong
 * samples, notes left, bytes written beyond the instrument's memory, and lost states.
 *
 *     fuzz COUNT SEED TABLES HELD SOUNDING
 *
 * TABLES has mappings that receive the usual channels; HELD and SOUNDING are the numbers of the
 * words of memory with the number of held keys, and of the one that sounds.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "yehu.h"

#define BLOCK 128
#define AT_ONCE 1000 /* messages before a block */
#define ROUND 10     /* blocks until all notes end */
#define GUARD 4096   /* bytes around the instrument */
#define WORDS (sizeof(struct yehu_tables) / sizeof(double))

static uint64_t state;
static struct yehu_tables given;
static float out[2 * BLOCK];
static long wrong;

static uint64_t any(void) { /* xorshift64* */
    state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
    return state * 2685821657736338717u >> 16;
}

static int64_t below(int64_t n) { return (int64_t)(any() % (uint64_t)n); }

static long message(void *yehu, int64_t frame) {
    uint8_t bytes[3];
    int n = 1 + (int)below(3), port = (int)below(16);
    for (int i = 0; i < n; i++) bytes[i] = (uint8_t)any();
    if (below(10)) { /* mostly a whole one */
        n = 3;
        bytes[0] |= 0x80, bytes[1] &= 0x7F, bytes[2] &= 0x7F;
        if (below(3) == 0) bytes[0] = (uint8_t)(0x90 | (bytes[0] & 0x0F));
        if (bytes[0] >= 0xC0 && bytes[0] < 0xE0) n = 2;
    }
    if (port == 0) return yehu_midi(yehu, frame, bytes, n);
    if (below(100) == 0) return yehu_post(yehu, frame, YEHU_MESSAGE, (int64_t)any(), 0.0, 0.0);
    int64_t packed = YEHU_PACKED(bytes[0], n > 1 ? bytes[1] : 0, n > 2 ? bytes[2] : 0, n, port);
    return yehu_post(yehu, frame, YEHU_MESSAGE, packed, 0.0, 0.0);
}

static double wild(void) {
    static const double some[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 1e-310, -1, 0.5, 1e9};
    int way = (int)below(4);
    return way == 0 ? some[below(sizeof some / sizeof *some)] : (double)below(way == 1 ? 5 : 3000);
}

/* Gives one of some tables, mostly with wrong numbers; returns what yehu_use_tables does. */
static int64_t map(void *yehu, int64_t frame, FILE *tables, long count) {
    fseek(tables, below(count) * (long)sizeof given, SEEK_SET);
    if (fread(&given, sizeof given, 1, tables) != 1) exit(6);
    for (int64_t i = below(8); i > 0; i--) {
        /* mostly in the first binds, which are used */
        int64_t place = below(2) ? 1 + 256 * below(17) + below(8) : below(WORDS);
        ((double *)&given)[place] = wild();
    }
    given.received = -1.0;
    return yehu_use_tables(yehu, frame, &given, sizeof given);
}

static void play(void *yehu, long blocks) {
    while (blocks--) {
        yehu_process(yehu, out, BLOCK);
        for (int i = 0; i < 2 * BLOCK; i++) wrong += !isfinite(out[i]);
    }
}

/* Ends all notes in one of three ways. */
static void end_all(void *yehu) {
    int64_t frame = yehu_frame(yehu), way = below(3);
    if (way < 2) yehu_post(yehu, frame, YEHU_RELEASE_ALL, 0, (double)way, 0.0);
    for (int port = 0; way == 2 && port < 16; port++)
        for (int channel = 0; channel < 16; channel++)
            for (int each = 0; each < 2; each++) /* the pedal is lifted; all notes off */
                yehu_post(yehu, frame, YEHU_MESSAGE,
                          YEHU_PACKED(0xB0 | channel, each ? 123 : 64, 0, 3, port), 0.0, 0.0);
}

int main(int count, char **words) {
    if (count != 6) return 2;
    long wanted = atol(words[1]), held = atol(words[4]), sounding = atol(words[5]);
    long posted = 0, taken = 0, refused = 0, left = 0, beyond = 0;
    size_t size = (yehu_size() + 63) / 64 * 64;
    uint8_t *memory = aligned_alloc(64, size + 2 * GUARD);
    FILE *tables = fopen(words[3], "rb");
    if (!memory || !tables || fseek(tables, 0, SEEK_END)) return 3;
    long mappings = ftell(tables) / (long)sizeof given;
    state = strtoull(words[2], NULL, 10) * 2 + 1;
    memset(memory, 0xA5, size + 2 * GUARD);
    void *yehu = memory + GUARD;
    if (!yehu_prepare(yehu, 48000.0, 2)) return 4;
    for (long block = 1; posted < wanted; block++) {
        int64_t frame = yehu_frame(yehu), mapped = map(yehu, frame + below(BLOCK), tables, mappings);
        taken += mapped == 1, refused += mapped == -1;
        for (int i = 0; i < AT_ONCE; i++) posted += message(yehu, frame + below(BLOCK));
        play(yehu, 1);
        if (block % ROUND) continue;
        play(yehu, 400); /* what waits is applied, so many commands a frame */
        end_all(yehu);
        play(yehu, 400);
        int64_t *record = yehu;
        left += record[held] != 0 || record[sounding] != -1 || !isnan(yehu_pitch(yehu));
    }
    for (size_t i = 0; i < GUARD; i++) beyond += memory[i] != 0xA5;
    for (size_t i = GUARD + (size_t)yehu_size(); i < size + 2 * GUARD; i++) beyond += memory[i] != 0xA5;
    printf("%ld %ld %ld %ld %ld %ld %ld\n", posted, taken, refused, wrong, left, beyond,
           (long)yehu_lost(yehu));
    return 0;
}
