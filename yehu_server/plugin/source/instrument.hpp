/* One instrument in a host: its memory, rate, parameters and state. It knows no format of plug-ins.
 *
 * `begin` and what is said to be for the main thread may allocate; nothing else does. Offsets are
 * frames of the host from the beginning of the block that is processed next.
 */
#ifndef YEHU_INSTRUMENT_HPP
#define YEHU_INSTRUMENT_HPP

#include <atomic>
#include <stddef.h>
#include <stdint.h>

#include "engine.hpp"
#include "resampler.hpp"
#include "settings.hpp"

namespace yehu {

class Instrument {
public:
    Instrument();
    ~Instrument();
    Instrument(const Instrument &) = delete;
    Instrument &operator=(const Instrument &) = delete;

    /* Prepare for a rate (Hz), while nothing is processed; false where there is no memory. */
    bool begin(double rate);
    bool is_ready() const { return rig != nullptr; }
    int latency() const { return resampler.latency(); }
    double tail_seconds() const;

    /* From the audio thread; in each block first `transport`, if the host has one, and
     * `begin_block`, then what happens in it, and at last `process`. The transport does not play yet
     * where a host counts in, before the song: how long that takes may differ from time to time. */
    void reset();
    void transport(bool plays);
    void begin_block();
    void parameter(uint32_t offset, int parameter, double value);
    void midi(uint32_t offset, const uint8_t *bytes, size_t size);
    void note_on(uint32_t offset, int channel, int key, double velocity);
    void note_off(uint32_t offset, int channel, int key);
    /* Notes that have expressions of their own; -1 stands for any id, channel or key. */
    void own_note_on(uint32_t offset, int id, int channel, int key, double velocity);
    void own_note_off(uint32_t offset, int id, int channel, int key);
    void express(uint32_t offset, int kind, int id, int channel, int key, double value);
    void process(float *left, float *right, uint32_t frames);

    /* From any thread. */
    double value(int parameter) const { return settings.value(parameter); }
    const Settings &all() const { return settings; }
    /* As `parameter`, between blocks. */
    void flush(int parameter, double value);
    /* From the window: heard from the next block on, and to be reported to the host. */
    void edit(int parameter, double value);
    /* Whether the window, or something else than the host, changed a parameter since this was asked. */
    bool was_edited(int parameter) { return take_flag(edited_bits, parameter); }
    bool was_moved(int parameter) { return take_flag(moved_bits, parameter); }
    bool has_moved() const;
    /* The host has a value now: another one from there is a change. */
    void know(int parameter, double value) { known[parameter].store(value, std::memory_order_relaxed); }

    /* What is to be seen of it, from the main thread; false before `begin`. */
    bool snapshot(struct yehu_snapshot *into) const;

    /* State as text; `save` returns its length, which may be more than `size`. */
    size_t save(char *into, size_t size) const { return settings.save(into, size); }
    bool load(const char *text, size_t size);

private:
    static constexpr int WORDS = (PARAMETERS + 31) / 32;
    static constexpr int MEMBERS = 15;
    struct Note { int id, channel, key; bool sounds, touched; };

    using Bits = std::atomic<uint32_t>[WORDS];
    static void flag(Bits &bits, int parameter);
    static bool take_flag(Bits &bits, int parameter);
    bool is_old(int parameter, double value);
    void forget_host();
    int64_t frame_at(uint32_t offset) const;
    void post(int64_t frame, int kind, int64_t index, double value, double other = 0.0);
    void message(int64_t frame, int status, int one, int two);
    void apply(int64_t frame, int parameter);
    void use_tables();
    void set_zone();
    int member_of(int id, int channel, int key) const;

    const Engine &code;
    void *allocated = nullptr, *rig = nullptr;
    yehu_tables *tables = nullptr;
    Resampler resampler;
    Settings settings;
    /* Of the host: what it has, as far as is known; what it sent last, and in which block, or in which
     * block it was changed by something else. */
    std::atomic<double> known[PARAMETERS], sent[PARAMETERS];
    std::atomic<uint32_t> sent_in[PARAMETERS], block;
    Bits set_bits, moved_bits, edited_bits;
    bool wants_tables = false, wants_zone = false, plays = false;
    Note notes[MEMBERS];
    int latest = 0;
};

} /* namespace yehu */

#endif
