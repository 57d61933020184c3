/* Makes the sound of one rate into that of another: a windowed sinc, whose phases are exact where the
 * rates have a common divisor that is large enough, as all usual ones have, and interpolated else.
 */
#ifndef YEHU_RESAMPLER_HPP
#define YEHU_RESAMPLER_HPP

#include <stdint.h>

namespace yehu {

class Resampler {
public:
    ~Resampler();
    bool prepare(int64_t from, int64_t to); /* rates; not for the audio thread, as it allocates */
    void reset();
    bool is_needed() const { return from != to; }
    int latency() const; /* frames of the other rate */
    /* The frame that sounds, at the first rate, when so many frames more are made. */
    int64_t frame_after(int64_t frames) const;
    int64_t most_at_once() const { return piece; }
    int64_t wanted(int64_t frames) const { return frame_after(frames - 1) + 1 - read; }
    float *room() { return heard + 2 * taps; } /* for that many pairs of left and right */
    void make(float *left, float *right, int64_t frames);

private:
    int64_t from = 1, to = 1;
    int64_t read = 0, made = 0; /* frames since the reset */
    int64_t piece = 0, held = 0;
    int half = 0, taps = 0, phases = 0;
    float *table = nullptr, *heard = nullptr;
};

} /* namespace yehu */

#endif
