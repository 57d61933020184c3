/* A small CLAP host: plays a script by a plug-in, and reports what happened.
 *
 *     host PLUGIN RATE BLOCK FRAMES SCRIPT SAMPLES
 *
 * BLOCK 0: blocks of changing sizes, 1 to 4096. Each line of SCRIPT begins with a frame, in order:
 *
 *     FRAME midi STATUS ONE TWO              FRAME on ID CHANNEL KEY VELOCITY
 *     FRAME off ID CHANNEL KEY               FRAME choke ID CHANNEL KEY
 *     FRAME express KIND ID VALUE            FRAME set NUMBER VALUE
 *     FRAME modulate NUMBER VALUE            FRAME foreign NUMBER VALUE (set, of an unknown space)
 *     FRAME time 0|1 (inside a block)        FRAME play 0|1 [TEMPO] (from a block on; -1: counts in;
 *                                            with a tempo from the beginning of a loop)
 *     FRAME reset      FRAME save FILE      FRAME load FILE      FRAME rate HZ (0: as it is)
 *     FRAME flush NUMBER VALUE               FRAME idle NUMBER VALUE (flush, while it is not active)
 *
 * The first ten are events of a block, or sent with it; the others happen between two blocks.
 * Prints lines: a word and numbers. "odd": samples that are not finite, denormal, not written, or
 * beyond the block; "names": of keys, the last of these keys, and how often they changed; "untrue": a parameter, and a value whose text does not lead back to itself.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <clap/entry.h>
#include <clap/ext/latency.h>
#include <clap/ext/params.h>
#include <clap/ext/state.h>
#include <clap/plugin-factory.h>

#ifdef _WIN32
#include <windows.h>
#define dlopen(path, how) ((void *)LoadLibraryA(path))
#define dlsym(library, name) ((void *)GetProcAddress(library, name))
#define dlerror() "no library, or no entry"
#else
#include <dlfcn.h>
#endif

#ifdef UNCOUNTED /* where malloc cannot be replaced */
static long allocations(void) { return 0; }
#else
#include "../ahead/counted.h"
#endif

#define MOST 65536
#define MAX_BLOCK 16384
#define MAX_CHANGING 4096
#define PIECE 17    /* bytes of a state that are taken at once: a host may take less than it is given */
#define UNKNOWN 333 /* a space of events */
#define TEXTS 50    /* values of a parameter whose texts are tried */

struct line { long frame; char word[16]; double number[4]; char text[256]; };
static struct line lines[MOST];
static int count, first, last; /* those of the block are from `first` to before `last` */
static union {
    clap_event_header_t header;
    clap_event_midi_t midi;
    clap_event_note_t note;
    clap_event_note_expression_t expression;
    clap_event_param_value_t param;
    clap_event_param_mod_t modulation;
    clap_event_transport_t transport;
} events[MOST];
static uint32_t in_block;
static long printed;

static uint32_t CLAP_ABI size_of(const clap_input_events_t *list) { return (void)list, in_block; }
static const clap_event_header_t *CLAP_ABI get(const clap_input_events_t *list, uint32_t i) {
    return (void)list, &events[i].header;
}
static bool CLAP_ABI push(const clap_output_events_t *list, const clap_event_header_t *event) {
    const clap_event_param_value_t *param = (const void *)event;
    (void)list;
    if (event->type == CLAP_EVENT_PARAM_VALUE) {
        printed++;
        printf("moved %u %.17g\n", param->param_id, param->value);
    }
    return true;
}
static const clap_input_events_t event_list = {NULL, size_of, get};
static const clap_output_events_t ignored = {NULL, push};
/* As clap/ext/note-name.h, which older sets of headers have not. */
static const char *const NAMES = "clap.note-name";
typedef struct { char name[CLAP_NAME_SIZE]; int16_t port, key, channel; } note_name;
typedef struct {
    uint32_t(CLAP_ABI *count)(const clap_plugin_t *);
    bool(CLAP_ABI *get)(const clap_plugin_t *, uint32_t, note_name *);
} plugin_names;
static long calls_wanted, names_changed;

static void CLAP_ABI nothing(const clap_host_t *host) { (void)host; }
static void CLAP_ABI want_call(const clap_host_t *host) { (void)host, calls_wanted++; }
static void CLAP_ABI hear_names(const clap_host_t *host) { (void)host, names_changed++; }
static const struct { void(CLAP_ABI *changed)(const clap_host_t *); } host_names = {hear_names};
static const void *CLAP_ABI extension(const clap_host_t *host, const char *id) {
    return (void)host, strcmp(id, NAMES) ? NULL : &host_names;
}

static int64_t CLAP_ABI put(const clap_ostream_t *stream, const void *bytes, uint64_t n) {
    n = n > PIECE ? PIECE : n;
    return fwrite(bytes, 1, n, stream->ctx) == n ? (int64_t)n : -1;
}
static int64_t CLAP_ABI take(const clap_istream_t *stream, void *bytes, uint64_t n) {
    return (int64_t)fread(bytes, 1, n > PIECE ? PIECE : n, stream->ctx);
}

static int is_event(const char *word) {
    const char *words[] = {"midi", "on", "off", "choke", "express", "set", "modulate", "foreign", "time"};
    for (unsigned i = 0; i < sizeof words / sizeof *words; i++)
        if (!strcmp(word, words[i])) return 1;
    return 0;
}

static void add_event(const struct line *line, long at) {
    const double *n = line->number;
    clap_event_header_t header = {0, (uint32_t)at, CLAP_CORE_EVENT_SPACE_ID, 0, 0};
    if (!strcmp(line->word, "midi")) {
        clap_event_midi_t e = {header, 0, {(uint8_t)n[0], (uint8_t)n[1], (uint8_t)n[2]}};
        events[in_block].midi = e;
        header.type = CLAP_EVENT_MIDI, header.size = sizeof e;
    } else if (!strcmp(line->word, "express")) {
        clap_event_note_expression_t e = {header, (int)n[0], (int)n[1], -1, -1, -1, n[2]};
        events[in_block].expression = e;
        header.type = CLAP_EVENT_NOTE_EXPRESSION, header.size = sizeof e;
    } else if (!strcmp(line->word, "time")) {
        clap_event_transport_t e = {header, .flags = n[0] ? CLAP_TRANSPORT_IS_PLAYING : 0};
        events[in_block].transport = e;
        header.type = CLAP_EVENT_TRANSPORT, header.size = sizeof e;
    } else if (!strcmp(line->word, "modulate")) {
        clap_event_param_mod_t e = {header, (clap_id)n[0], NULL, -1, -1, -1, -1, n[1]};
        events[in_block].modulation = e;
        header.type = CLAP_EVENT_PARAM_MOD, header.size = sizeof e;
    } else if (!strcmp(line->word, "on") || !strcmp(line->word, "off") || !strcmp(line->word, "choke")) {
        const int is_on = line->word[1] == 'n', is_choke = *line->word == 'c';
        clap_event_note_t e = {header, (int)n[0], 0, (int16_t)n[1], (int16_t)n[2], is_on ? n[3] : 0.0};
        events[in_block].note = e;
        header.type = is_on ? CLAP_EVENT_NOTE_ON : is_choke ? CLAP_EVENT_NOTE_CHOKE : CLAP_EVENT_NOTE_OFF;
        header.size = sizeof e;
    } else { /* of a parameter */
        clap_event_param_value_t e = {header, (clap_id)n[0], NULL, -1, -1, -1, -1, n[1]};
        events[in_block].param = e;
        header.type = CLAP_EVENT_PARAM_VALUE, header.size = sizeof e;
        if (!strcmp(line->word, "foreign")) header.space_id = UNKNOWN;
    }
    events[in_block++].header = header;
}

static void read_script(const char *path) {
    char text[512];
    FILE *file = fopen(path, "r");
    while (file && count < MOST && fgets(text, sizeof text, file)) {
        struct line *line = &lines[count];
        double *n = line->number;
        if (sscanf(text, "%ld %15s %255[^\n]", &line->frame, line->word, line->text) < 2) continue;
        sscanf(line->text, "%lf %lf %lf %lf", n, n + 1, n + 2, n + 3);
        count++;
    }
    if (file) fclose(file);
}

static void between(const clap_plugin_t *plugin, const struct line *line, double *rate) {
    const clap_plugin_state_t *state = plugin->get_extension(plugin, CLAP_EXT_STATE);
    if (!strcmp(line->word, "reset")) plugin->reset(plugin);
    if (!strcmp(line->word, "save")) {
        const clap_ostream_t stream = {fopen(line->text, "wb"), put};
        printf("saved %d\n", state->save(plugin, &stream));
        fclose(stream.ctx);
    }
    if (!strcmp(line->word, "load")) {
        const clap_istream_t stream = {fopen(line->text, "rb"), take};
        printf("loaded %d\n", state->load(plugin, &stream));
        fclose(stream.ctx);
    }
    const int is_idle = !strcmp(line->word, "idle"), is_rate = !strcmp(line->word, "rate");
    if (is_idle || is_rate) plugin->stop_processing(plugin), plugin->deactivate(plugin);
    if (is_idle || !strcmp(line->word, "flush")) {
        const clap_plugin_params_t *params = plugin->get_extension(plugin, CLAP_EXT_PARAMS);
        in_block = 0, add_event(line, 0);
        params->flush(plugin, &event_list, &ignored);
    }
    if (is_idle || is_rate) {
        *rate = is_rate && line->number[0] > 0.0 ? line->number[0] : *rate;
        if (!plugin->activate(plugin, *rate, 1, MAX_BLOCK) || !plugin->start_processing(plugin)) exit(5);
    }
}

/* One kind of plug-in, and each feature once. */
static int is_instrument(const char *const *features) {
    int found = 0;
    for (int i = 0; features[i]; i++) {
        found += !strcmp(features[i], CLAP_PLUGIN_FEATURE_INSTRUMENT);
        for (int before = 0; before < i; before++)
            if (!strcmp(features[i], features[before])) return 0;
    }
    return found == 1;
}

static int is_odd(float sample) { return sample != 0.0f && !isnormal(sample); }

/* Whether a value's text leads to a value that has the same text, and that again to the same value. */
static int is_true(const clap_plugin_t *plugin, const clap_plugin_params_t *params, clap_id id, double value) {
    char first[64], second[64];
    double back, again;
    return params->value_to_text(plugin, id, value, first, sizeof first) &&
           params->text_to_value(plugin, id, first, &back) &&
           params->value_to_text(plugin, id, back, second, sizeof second) && !strcmp(first, second) &&
           params->text_to_value(plugin, id, second, &again) && again == back;
}

static double seconds(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
}

int main(int words, char **word) {
    if (words != 7) return 2;
    double rate = atof(word[2]);
    const long block = atol(word[3]), frames = atol(word[4]);
    read_script(word[5]);
    void *library = dlopen(word[1], RTLD_NOW | RTLD_LOCAL);
    const clap_plugin_entry_t *entry = library ? dlsym(library, "clap_entry") : NULL;
    if (!entry || !entry->init(word[1])) return fprintf(stderr, "%s\n", dlerror()), 3;
    const clap_plugin_factory_t *factory = entry->get_factory(CLAP_PLUGIN_FACTORY_ID);
    const clap_host_t host = {CLAP_VERSION, NULL, "host", "", "", "1", extension, nothing, nothing, want_call};
    const clap_plugin_descriptor_t *about = factory->get_plugin_descriptor(factory, 0);
    if (entry->get_factory("clap.no-such-factory") || factory->get_plugin_count(factory) != 1) return 8;
    if (!is_instrument(about->features) || factory->create_plugin(factory, &host, "x")) return 9;
    char longer[128];
    snprintf(longer, sizeof longer, "%sx", about->id);
    if (factory->create_plugin(factory, &host, longer)) return 10;
    const double began = seconds(CLOCK_MONOTONIC);
    const clap_plugin_t *plugin = factory->create_plugin(factory, &host, about->id);
    if (!plugin || strcmp(plugin->desc->id, about->id) || !plugin->init(plugin)) return 4;
    if (!plugin->activate(plugin, rate, 1, MAX_BLOCK) || !plugin->start_processing(plugin)) return 5;
    printf("opened %g\n", seconds(CLOCK_MONOTONIC) - began);
    const clap_plugin_latency_t *latency = plugin->get_extension(plugin, CLAP_EXT_LATENCY);
    const clap_plugin_latency_t *tail = plugin->get_extension(plugin, "clap.tail");
    printf("latency %u\ntail %u\n", latency->get(plugin), tail->get(plugin));
    float *sound = calloc(2 * frames + 1, sizeof *sound), left[MAX_BLOCK + 1], right[MAX_BLOCK + 1];
    float *both[2] = {left, right};
    clap_audio_buffer_t out = {both, NULL, 2, 0, 0};
    clap_event_transport_t transport = {{sizeof transport, 0, CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_TRANSPORT, 0}, .flags = 0};
    long allocated = 0, changing = 1, odd = 0;
    double took = 0.0, longest = 0.0;
    for (long done = 0, now; done < frames; done += now) {
        changing = changing * 1103515245 + 12345;
        now = block > 0 ? block : 1 + (changing >> 16 & (MAX_CHANGING - 1));
        now = now < frames - done ? now : frames - done;
        for (; last < count && lines[last].frame <= done && !is_event(lines[last].word); last++) {
            const double tempo = lines[last].number[1];
            if (!strcmp(lines[last].word, "play"))
                transport.flags = (lines[last].number[0] != 0.0 ? CLAP_TRANSPORT_IS_PLAYING : 0u) |
                                  CLAP_TRANSPORT_HAS_SECONDS_TIMELINE |
                                  (tempo > 0.0 ? CLAP_TRANSPORT_HAS_TEMPO | CLAP_TRANSPORT_IS_LOOP_ACTIVE : 0u),
                transport.tempo = tempo, transport.loop_end_seconds = CLAP_SECTIME_FACTOR,
                transport.song_pos_seconds = lines[last].number[0] < 0.0 ? -CLAP_SECTIME_FACTOR : 0;
            else between(plugin, &lines[last], &rate);
        }
        in_block = 0;
        for (first = last; last < count && lines[last].frame < done + now; last++) {
            if (!is_event(lines[last].word)) { /* it is between two blocks: a block ends there */
                now = lines[last].frame - done;
                break;
            }
            add_event(&lines[last], lines[last].frame - done);
        }
        const clap_process_t process = {done, (uint32_t)now, &transport, NULL, &out, 0, 1, &event_list, &ignored};
        for (long n = 0; n <= now; n++) left[n] = right[n] = NAN;
        const long before = allocations();
        const double start = seconds(CLOCK_THREAD_CPUTIME_ID);
        if (plugin->process(plugin, &process) == CLAP_PROCESS_ERROR) return 6;
        const double one = seconds(CLOCK_THREAD_CPUTIME_ID) - start;
        if (!printed) allocated += allocations() - before; /* printing allocates once */
        took += one, longest = one > longest ? one : longest;
        for (long n = 0; n < now; n++)
            sound[2 * (done + n)] = left[n], sound[2 * (done + n) + 1] = right[n],
            odd += is_odd(left[n]) + is_odd(right[n]);
        odd += !isnan(left[now]) + !isnan(right[now]);
    }
    const clap_plugin_params_t *params = plugin->get_extension(plugin, CLAP_EXT_PARAMS);
    for (uint32_t i = 0; i < params->count(plugin); i++) {
        clap_param_info_t info;
        char text[64] = "";
        double value = NAN, back = NAN;
        params->get_info(plugin, i, &info);
        params->get_value(plugin, info.id, &value);
        params->value_to_text(plugin, info.id, value, text, sizeof text);
        params->text_to_value(plugin, info.id, text, &back);
        printf("value %u %.17g %.17g\n", info.id, value, back);
        for (int n = 0; n < TEXTS; n++) {
            value = info.min_value + (info.max_value - info.min_value) * n / (TEXTS - 1);
            if (!is_true(plugin, params, info.id, value)) printf("untrue %u %.17g\n", info.id, value);
        }
    }
    for (; calls_wanted > 0; calls_wanted--) plugin->on_main_thread(plugin);
    const plugin_names *names = plugin->get_extension(plugin, NAMES);
    note_name named = {.key = -1};
    for (uint32_t i = 0; i < names->count(plugin); i++)
        if (!names->get(plugin, i, &named) || named.port != -1 || named.channel != -1) return 11;
    if (names->get(plugin, names->count(plugin), &named)) return 12;
    printf("names %u %d %ld\n", names->count(plugin), named.key, names_changed);
    if (names->count(plugin)) printf("last-%s\n", named.name);
    printf("odd %ld\nallocated %ld\ntook %g\nlongest %g\n", odd, allocated, took, longest);
    plugin->stop_processing(plugin), plugin->deactivate(plugin), plugin->destroy(plugin);
    entry->deinit();
    FILE *file = fopen(word[6], "wb");
    return file && fwrite(sound, 2 * sizeof *sound, frames, file) == (size_t)frames && !fclose(file) ? 0 : 7;
}
