#include "resampler.hpp"

#include <math.h>
#include <stdlib.h>
#include <string.h>

namespace yehu {

namespace {
constexpr int HALF = 32;          /* of the taps, where the rate rises */
constexpr int MAX_PHASES = 512;
constexpr int64_t PIECE = 256;    /* frames made at once, and */
constexpr int64_t HEARD = 1024;   /* read at once, at most */
constexpr double PASSED = 0.93;   /* of the lower rate's band: to 20.5 kHz at 44.1 kHz */
constexpr double PI = 3.14159265358979323846;

int64_t divisor(int64_t a, int64_t b) { return b == 0 ? a : divisor(b, a % b); }
} /* namespace */

Resampler::~Resampler() {
    free(table);
    free(heard);
}

bool Resampler::prepare(int64_t from_rate, int64_t to_rate) {
    const int64_t common = divisor(from_rate, to_rate);
    from = from_rate / common, to = to_rate / common;
    free(table);
    free(heard);
    table = heard = nullptr;
    if (!is_needed()) return true;
    const double fall = from > to ? (double)from / (double)to : 1.0;
    half = 2 * (int)ceil(HALF / 2 * fall), taps = 2 * half;
    phases = (int)(to < MAX_PHASES ? to : MAX_PHASES);
    piece = PIECE;
    while (piece > 1 && piece * from / to + 2 > HEARD) piece /= 2;
    table = (float *)malloc(sizeof(float) * (size_t)((phases + 2) * taps));
    heard = (float *)malloc(sizeof(float) * 2 * (size_t)(taps + HEARD));
    if (!table || !heard) return false;
    const double cut = PASSED / fall;
    for (int phase = 0; phase <= phases + 1; phase++)
        for (int tap = 0; tap < taps; tap++) {
            const double t = tap - half + 1 - (double)phase / phases, turn = PI * t / half;
            const double window = 0.42 + 0.5 * cos(turn) + 0.08 * cos(2.0 * turn); /* Blackman */
            const double sinc = t == 0.0 ? 1.0 : sin(PI * cut * t) / (PI * cut * t);
            table[phase * taps + tap] = fabs(t) < half ? (float)(cut * window * sinc) : 0.0f;
        }
    reset();
    return true;
}

void Resampler::reset() {
    read = made = 0;
    if (heard) memset(heard, 0, sizeof(float) * 2 * (size_t)taps);
}

int Resampler::latency() const {
    return is_needed() ? (int)((half * to + from / 2) / from) : 0;
}

int64_t Resampler::frame_after(int64_t frames) const { return (made + frames) * from / to; }

void Resampler::make(float *left, float *right, int64_t frames) {
    const int64_t count = wanted(frames), first = read; /* `room` has the frames from `first` on */
    for (int64_t n = 0; n < frames; n++) {
        const int64_t place = (made + n) * from, frame = place / to;
        const double at = (double)(place % to) * phases / (double)to;
        const int phase = (int)at;
        const float rest = (float)(at - phase);
        const float *tap = table + phase * taps, *next = tap + taps;
        const float *pair = heard + 2 * (frame - first + 1);
        float sum[8] = {}; /* left and right of four taps, so that the compiler can use vectors */
        for (int k = 0; k < taps; k += 4)
            for (int lane = 0; lane < 8; lane++) {
                const int each = k + lane / 2;
                const float weight = tap[each] + rest * (next[each] - tap[each]);
                sum[lane] += weight * pair[2 * k + lane];
            }
        left[n] = (sum[0] + sum[2]) + (sum[4] + sum[6]);
        right[n] = (sum[1] + sum[3]) + (sum[5] + sum[7]);
    }
    made += frames, read += count;
    memmove(heard, heard + 2 * count, sizeof(float) * 2 * (size_t)taps);
}

} /* namespace yehu */
