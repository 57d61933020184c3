#include "instrument.hpp"

#include <math.h>
#include <stdlib.h>
#include <string.h>

namespace yehu {

namespace {
constexpr int64_t RATES[] = {44100, 48000}; /* that there are images for */
constexpr int64_t AT_ONCE = 256;            /* frames */
constexpr size_t LINE = 64;                 /* bytes that memory is aligned to */
constexpr int OWN_PORT = 1;                 /* of notes with expressions: an MPE zone */
constexpr double STILL_S = 1.0;
} /* namespace */

Instrument::Instrument() : code(engine()) {
    for (int word = 0; word < WORDS; word++) set_bits[word] = moved_bits[word] = edited_bits[word] = 0;
    block = 0;
    forget_host();
    memset(notes, 0, sizeof notes);
}

Instrument::~Instrument() {
    free(allocated);
    free(tables);
}

bool Instrument::begin(double rate) {
    const int64_t wanted = (int64_t)(rate + 0.5);
    if (wanted <= 0) return false;
    int64_t own = wanted % 11025 == 0 ? RATES[0] : RATES[1];
    if (!allocated) {
        /* Pages that are never written to take no memory, so they are not cleared here. */
        allocated = malloc((size_t)code.size() + LINE);
        tables = (yehu_tables *)calloc(1, sizeof *tables);
    }
    if (!allocated || !tables || !resampler.prepare(own, wanted)) return false;
    void *aligned = (void *)(((uintptr_t)allocated + LINE - 1) / LINE * LINE);
    if (!code.prepare(aligned, (double)own, 2)) return false;
    rig = aligned;
    memset(notes, 0, sizeof notes);
    wants_zone = true;
    wants_tables = value(MAPPING) != 0.0 || value(TUNING) != 0.0; /* else it has them */
    for (int i = 0; i < PARAMETERS; i++)
        if (parameters[i].index >= 0 && value(i) != code.value(rig, parameters[i].index)) flag(set_bits, i);
    return true;
}

double Instrument::tail_seconds() const {
    return STILL_S + 1e-3 * value(RELEASE) + value(DECAY);
}

void Instrument::reset() {
    if (!rig) return;
    code.reset(rig); /* what was set and not heard yet is set by the next block */
    resampler.reset();
    memset(notes, 0, sizeof notes);
}

void Instrument::transport(bool is_playing) {
    const bool begins = is_playing && !plays;
    plays = is_playing;
    if (begins && rig && value(CHANCE) >= 0.5 && isnan(code.pitch(rig))) reset();
}

/* -- parameters ------------------------------------------------------------------------------- */

void Instrument::flag(Bits &bits, int parameter) { bits[parameter / 32].fetch_or(1u << parameter % 32); }

bool Instrument::take_flag(Bits &bits, int parameter) {
    const uint32_t bit = 1u << parameter % 32;
    return (bits[parameter / 32].load(std::memory_order_relaxed) & bit) && (bits[parameter / 32].fetch_and(~bit) & bit);
}

bool Instrument::has_moved() const {
    uint32_t any = 0;
    for (int word = 0; word < WORDS; word++) any |= moved_bits[word] | edited_bits[word];
    return any != 0;
}

/* Hosts send values again, block after block or as they begin: also the old one of a parameter that a
 * preset or the window has changed since. It is no command if the host has not heard of that change, or
 * has sent the same in the last block. */
bool Instrument::is_old(int parameter, double value) {
    const auto usual = std::memory_order_relaxed;
    const bool repeats = block.load(usual) - sent_in[parameter].load(usual) <= 1 && is_same(parameter, value, sent[parameter].load(usual));
    sent[parameter].store(value, usual), sent_in[parameter].store(block.load(usual), usual);
    if (is_same(parameter, value, this->value(parameter))) return know(parameter, value), false;
    if (!repeats && !is_same(parameter, value, known[parameter].load(usual))) return know(parameter, value), false;
    flag(moved_bits, parameter); /* so that it hears of it */
    for (int set = 0; set < SETS; set++) flag(moved_bits, set);
    return true;
}

void Instrument::forget_host() {
    for (int i = 0; i < PARAMETERS; i++) known[i] = sent[i] = value(i), sent_in[i] = block - 2;
}

void Instrument::flush(int parameter, double value) {
    block += 2; /* what comes by itself repeats nothing */
    if (!(value - value == 0.0) || is_old(parameter, value)) return;
    settings.change(parameter, value, [=](int each, bool) {
        flag(set_bits, each);
        if (each != parameter) flag(moved_bits, each);
    });
}

void Instrument::edit(int parameter, double value) {
    settings.change(parameter, value, [=](int each, bool) {
        flag(set_bits, each);
        sent_in[each] = block.load();
        flag(each == parameter ? edited_bits : moved_bits, each);
    });
}

bool Instrument::load(const char *text, size_t size) {
    double before[PARAMETERS];
    for (int i = 0; i < PARAMETERS; i++) before[i] = value(i);
    if (!settings.load(text, size)) return false;
    for (int i = 0; i < PARAMETERS; i++)
        if (value(i) != before[i]) flag(set_bits, i);
    forget_host();
    return true;
}

bool Instrument::snapshot(struct yehu_snapshot *into) const {
    if (rig) code.snapshot(rig, into);
    return rig != nullptr;
}

void Instrument::parameter(uint32_t offset, int parameter, double value) {
    if (!(value - value == 0.0) || is_old(parameter, value)) return; /* or no finite number */
    const int64_t frame = frame_at(offset);
    /* Hosts send all values as they begin or load: what is so already is not taken from the player. */
    const int index = parameters[parameter].index;
    const double now = this->value(parameter);
    if (rig && index >= 0 && is_same(parameter, value, now) && now == code.value(rig, index)) return;
    settings.change(parameter, value, [=](int each, bool) {
        apply(frame, each);
        if (each == parameter) return;
        flag(moved_bits, each);
        sent_in[each].store(block.load(std::memory_order_relaxed), std::memory_order_relaxed);
    });
}

void Instrument::apply(int64_t frame, int parameter) {
    if (!rig) return;
    if (parameter == MAPPING || parameter == TUNING) {
        wants_tables = true;
        use_tables();
    } else if (parameters[parameter].index >= 0) {
        post(frame, YEHU_SET, parameters[parameter].index, value(parameter));
    }
}

void Instrument::begin_block() {
    block.fetch_add(1, std::memory_order_relaxed);
    if (!rig) return;
    if (wants_tables) use_tables();
    if (wants_zone) set_zone();
    const int64_t frame = code.frame(rig);
    for (int word = 0; word < WORDS; word++) {
        uint32_t bits = set_bits[word].load(std::memory_order_relaxed);
        if (bits == 0) continue;
        bits = set_bits[word].exchange(0);
        for (int bit = 0; bit < 32; bit++)
            if (bits & 1u << bit) apply(frame, 32 * word + bit);
    }
}

/* Give the instrument the tables of mapping and tuning, as soon as it takes them. */
void Instrument::use_tables() {
    const Runs *parts[] = {&mappings[(int)value(MAPPING)], &tunings[(int)value(TUNING)]};
    int64_t *words = (int64_t *)tables;
    memset(tables, 0, sizeof *tables);
    for (const Runs *runs : parts)
        for (int32_t at = 0; at < runs->words;) {
            const int64_t first = runs->word[at], count = runs->word[at + 1];
            memcpy(words + first, runs->word + at + 2, (size_t)count * sizeof *words);
            at += 2 + (int32_t)count;
        }
    if (code.use_tables(rig, code.frame(rig), tables, sizeof *tables) == 0) return;
    wants_tables = false;
    set_zone(); /* which other tables may have taken away */
}

/* Notes with expressions need a zone: of all channels of a port of their own. */
void Instrument::set_zone() {
    const int64_t frame = code.frame(rig);
    wants_zone = false;
    const int zone[][2] = {{101, 0}, {100, 6}, {6, MEMBERS}, {101, 127}, {100, 127}};
    for (const int *pair : zone) message(frame, 0xB0, pair[0], pair[1]);
}

/* -- what is played --------------------------------------------------------------------------- */

int64_t Instrument::frame_at(uint32_t offset) const {
    if (!rig) return 0;
    return resampler.is_needed() ? resampler.frame_after(offset) : code.frame(rig) + offset;
}

void Instrument::post(int64_t frame, int kind, int64_t index, double value, double other) {
    code.post(rig, frame, kind, index, value, other);
}

void Instrument::midi(uint32_t offset, const uint8_t *bytes, size_t size) {
    if (rig) code.midi(rig, frame_at(offset), bytes, (int64_t)size);
}

void Instrument::note_on(uint32_t offset, int channel, int key, double velocity) {
    if (rig) post(frame_at(offset), YEHU_NOTE_ON, channel & 15, key, fmax(velocity, 0.0));
}

void Instrument::note_off(uint32_t offset, int channel, int key) {
    if (rig) post(frame_at(offset), YEHU_NOTE_OFF, channel & 15, key);
}

/* -- notes with expressions of their own: each on a member channel of a zone ------------------ */

void Instrument::message(int64_t frame, int status, int one, int two) {
    const int length = (status & 0xE0) == 0xC0 ? 2 : 3;
    post(frame, YEHU_MESSAGE, YEHU_PACKED(status, one, length == 2 ? 0 : two, length, OWN_PORT), 0.0);
}

int Instrument::member_of(int id, int channel, int key) const {
    for (int i = 0; i < MEMBERS; i++) { /* the latest first */
        const int member = (latest + MEMBERS - i) % MEMBERS;
        const Note &note = notes[member];
        if (note.sounds && (id < 0 || note.id < 0 || note.id == id) &&
            (channel < 0 || note.channel == channel) && (key < 0 || note.key == key))
            return member;
    }
    return -1;
}

void Instrument::own_note_on(uint32_t offset, int id, int channel, int key, double velocity) {
    if (!rig) return;
    const int64_t frame = frame_at(offset);
    int member = latest;
    for (int i = 1; i <= MEMBERS; i++) {
        member = (latest + i) % MEMBERS;
        if (!notes[member].sounds) break;
    }
    Note &note = notes[member];
    if (note.sounds) post(frame, YEHU_NOTE_OFF, 16 * OWN_PORT + 1 + member, note.key);
    if (note.touched)
        for (const Expression &each : expressions)
            message(frame, each.status | (1 + member), each.controller, each.neutral);
    note = {id, channel, key, true, false};
    latest = member;
    post(frame, YEHU_NOTE_ON, 16 * OWN_PORT + 1 + member, key, fmax(velocity, 0.0));
}

void Instrument::own_note_off(uint32_t offset, int id, int channel, int key) {
    if (!rig) return;
    for (int member; (member = member_of(id, channel, key)) >= 0;) {
        notes[member].sounds = false;
        post(frame_at(offset), YEHU_NOTE_OFF, 16 * OWN_PORT + 1 + member, notes[member].key);
        if (id >= 0 || (channel >= 0 && key >= 0)) return;
    }
}

void Instrument::express(uint32_t offset, int kind, int id, int channel, int key, double value) {
    const int member = member_of(id, channel, key);
    if (!rig || member < 0 || kind < 0 || kind >= EXPRESSIONS) return;
    const Expression &each = expressions[kind];
    const double unit = fmin(fmax((value - each.lo) / (each.hi - each.lo), 0.0), 1.0);
    const int channel_status = each.status | (1 + member);
    notes[member].touched = true;
    if (each.status == 0xE0) { /* of 14 bits, the middle at 8192 */
        const int bend = 8192 + (int)floor((2.0 * unit - 1.0) * 8191.0 + 0.5);
        message(frame_at(offset), channel_status, bend & 127, bend >> 7);
        return;
    }
    const int step = (int)floor(127.0 * unit + 0.5);
    if (each.status == 0xD0) message(frame_at(offset), channel_status, step, 0);
    else message(frame_at(offset), channel_status, each.controller, step);
}

/* -- sound ------------------------------------------------------------------------------------ */

void Instrument::process(float *left, float *right, uint32_t frames) {
    if (!rig) {
        memset(left, 0, frames * sizeof *left);
        memset(right, 0, frames * sizeof *right);
        return;
    }
    float pairs[2 * AT_ONCE];
    for (int64_t done = 0; done < frames;) {
        int64_t now = frames - done;
        if (resampler.is_needed()) {
            now = now < resampler.most_at_once() ? now : resampler.most_at_once();
            const int64_t wanted = resampler.wanted(now);
            if (wanted > 0) code.process(rig, resampler.room(), wanted);
            resampler.make(left + done, right + done, now);
        } else {
            now = now < AT_ONCE ? now : AT_ONCE;
            code.process(rig, pairs, now);
            for (int64_t n = 0; n < now; n++)
                left[done + n] = pairs[2 * n], right[done + n] = pairs[2 * n + 1];
        }
        done += now;
    }
}

} /* namespace yehu */
