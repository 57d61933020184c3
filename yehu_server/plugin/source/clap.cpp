/* The plug-in for CLAP hosts. */
#include <new>
#include <stdlib.h>
#include <string.h>

#include <clap/entry.h>
#include <clap/ext/audio-ports.h>
#include <clap/ext/latency.h>
#include <clap/ext/params.h>
#include <clap/ext/state.h>
#include <clap/plugin-factory.h>

#include "clap.hpp"

namespace {

using namespace yehu;

/* -- ports ------------------------------------------------------------------------------------ */

uint32_t CLAP_ABI count_audio(const clap_plugin_t *, bool is_input) { return is_input ? 0 : 1; }

bool CLAP_ABI get_audio(const clap_plugin_t *, uint32_t index, bool is_input, clap_audio_port_info_t *info) {
    if (is_input || index > 0) return false;
    *info = {0, "Yehu", CLAP_AUDIO_PORT_IS_MAIN, 2, CLAP_PORT_STEREO, CLAP_INVALID_ID};
    return true;
}

const clap_plugin_audio_ports_t audio_ports = {count_audio, get_audio};

/* -- parameters and events -------------------------------------------------------------------- */

uint32_t CLAP_ABI count_parameters(const clap_plugin_t *) { return PARAMETERS; }

bool CLAP_ABI get_parameter(const clap_plugin_t *, uint32_t index, clap_param_info_t *info) {
    if (index >= PARAMETERS) return false;
    const Parameter &p = parameters[index];
    memset(info, 0, sizeof *info);
    info->id = p.number;
    info->flags = CLAP_PARAM_IS_AUTOMATABLE | (p.steps > 0 ? CLAP_PARAM_IS_STEPPED : 0);
    strncpy(info->name, p.name, sizeof info->name - 1);
    strncpy(info->module, p.group, sizeof info->module - 1);
    info->min_value = p.lo, info->max_value = p.hi, info->default_value = p.usual;
    return true;
}

bool CLAP_ABI get_value(const clap_plugin_t *plugin, clap_id number, double *value) {
    const int parameter = parameter_of(number);
    if (parameter < 0) return false;
    *value = of(plugin).instrument.value(parameter);
    return true;
}

bool CLAP_ABI to_text(const clap_plugin_t *plugin, clap_id number, double value, char *text, uint32_t size) {
    const int parameter = parameter_of(number);
    if (parameter < 0 || size == 0) return false;
    of(plugin).instrument.all().write(parameter, value, text, size);
    return true;
}

bool CLAP_ABI from_text(const clap_plugin_t *, clap_id number, const char *text, double *value) {
    const int parameter = parameter_of(number);
    return parameter >= 0 && Settings::read(parameter, text, value);
}

bool push_gesture(const clap_output_events_t *out, int parameter, uint16_t type) {
    const clap_event_param_gesture_t event = {{sizeof event, 0, CLAP_CORE_EVENT_SPACE_ID, type, 0}, parameters[parameter].number};
    return out->try_push(out, &event.header);
}

/* Report to the host parameters that the user changed in the window, and those that moved with another
 * one, which are not to be recorded. */
void report(Plugin &plugin, const clap_output_events_t *out) {
    Instrument &instrument = plugin.instrument;
    const bool has_moved = out && instrument.has_moved();
    for (int i = 0; has_moved && i < PARAMETERS; i++) {
        const bool is_edited = instrument.was_edited(i);
        if (!instrument.was_moved(i) && !is_edited) continue;
        clap_event_param_value_t event = {};
        event.header = {sizeof event, 0, CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_VALUE, is_edited ? 0u : CLAP_EVENT_DONT_RECORD};
        event.param_id = parameters[i].number;
        event.note_id = event.port_index = event.channel = event.key = -1;
        event.value = instrument.value(i);
        if (is_edited && plugin.gesture != i) push_gesture(out, i, CLAP_EVENT_PARAM_GESTURE_BEGIN);
        if (out->try_push(out, &event.header)) instrument.know(i, event.value);
        if (is_edited && plugin.held == i) plugin.gesture = i;
        else if (is_edited && plugin.gesture != i) push_gesture(out, i, CLAP_EVENT_PARAM_GESTURE_END);
    }
    if (out && plugin.gesture >= 0 && plugin.gesture != plugin.held) {
        push_gesture(out, plugin.gesture, CLAP_EVENT_PARAM_GESTURE_END);
        plugin.gesture = -1;
    }
    const bool has_other_names = watch_names(plugin);
    if (has_moved) plugin.wants_values = true;
    if (has_other_names) plugin.wants_names = true;
    if (has_moved || has_other_names) plugin.host->request_callback(plugin.host);
}

void take(Instrument &instrument, const clap_event_header_t *event) {
    if (event->space_id != CLAP_CORE_EVENT_SPACE_ID) return;
    const uint32_t at = event->time;
    switch (event->type) {
    case CLAP_EVENT_NOTE_ON: {
        const auto *note = (const clap_event_note_t *)event;
        instrument.own_note_on(at, note->note_id, note->channel, note->key, note->velocity);
        break;
    }
    case CLAP_EVENT_NOTE_OFF:
    case CLAP_EVENT_NOTE_CHOKE: {
        const auto *note = (const clap_event_note_t *)event;
        instrument.own_note_off(at, note->note_id, note->channel, note->key);
        break;
    }
    case CLAP_EVENT_NOTE_EXPRESSION: {
        const auto *e = (const clap_event_note_expression_t *)event;
        instrument.express(at, e->expression_id, e->note_id, e->channel, e->key, e->value);
        break;
    }
    case CLAP_EVENT_PARAM_VALUE: {
        const auto *changed = (const clap_event_param_value_t *)event;
        const int parameter = parameter_of(changed->param_id);
        if (parameter >= 0) instrument.parameter(at, parameter, changed->value);
        break;
    }
    case CLAP_EVENT_TRANSPORT:
        break; /* the block's own transport says it */
    case CLAP_EVENT_MIDI:
        instrument.midi(at, ((const clap_event_midi_t *)event)->data, 3);
        break;
    }
}

void CLAP_ABI flush(const clap_plugin_t *plugin, const clap_input_events_t *in, const clap_output_events_t *out) {
    Instrument &instrument = of(plugin).instrument;
    for (uint32_t i = 0, count = in ? in->size(in) : 0; i < count; i++) {
        const clap_event_header_t *event = in->get(in, i);
        if (event->space_id != CLAP_CORE_EVENT_SPACE_ID || event->type != CLAP_EVENT_PARAM_VALUE) continue;
        const auto *changed = (const clap_event_param_value_t *)event;
        const int parameter = parameter_of(changed->param_id);
        if (parameter >= 0) instrument.flush(parameter, changed->value);
    }
    report(of(plugin), out);
}

const clap_plugin_params_t params = {count_parameters, get_parameter, get_value, to_text, from_text, flush};

/* -- state, latency, tail --------------------------------------------------------------------- */

bool CLAP_ABI save_state(const clap_plugin_t *plugin, const clap_ostream_t *stream) {
    const Instrument &instrument = of(plugin).instrument;
    const size_t size = instrument.save(nullptr, 0) + 1;
    char *text = (char *)malloc(size);
    if (!text) return false;
    instrument.save(text, size);
    int64_t done = 0;
    for (const int64_t length = (int64_t)strlen(text); done < length;) {
        const int64_t written = stream->write(stream, text + done, (uint64_t)(length - done));
        if (written <= 0) break;
        done += written;
    }
    const bool is_whole = done == (int64_t)strlen(text);
    free(text);
    return is_whole;
}

/* What is shown of a value may have changed with it, as a preset that is changed. */
void rescan(const Plugin &plugin) {
    const auto *shown = (const clap_host_params_t *)plugin.host->get_extension(plugin.host, CLAP_EXT_PARAMS);
    if (shown && shown->rescan) shown->rescan(plugin.host, CLAP_PARAM_RESCAN_VALUES | CLAP_PARAM_RESCAN_TEXT);
}

bool CLAP_ABI load_state(const clap_plugin_t *plugin, const clap_istream_t *stream) {
    static const size_t most = 1 << 16;
    char *text = (char *)malloc(most);
    if (!text) return false;
    size_t length = 0;
    for (int64_t more; length < most; length += (size_t)more) {
        more = stream->read(stream, text + length, most - length);
        if (more <= 0) break;
    }
    const bool is_right = of(plugin).instrument.load(text, length);
    free(text);
    if (is_right) rescan(of(plugin));
    return is_right;
}

uint32_t CLAP_ABI get_latency(const clap_plugin_t *plugin) {
    return (uint32_t)of(plugin).instrument.latency();
}

uint32_t CLAP_ABI get_tail(const clap_plugin_t *plugin) {
    return (uint32_t)(of(plugin).instrument.tail_seconds() * of(plugin).rate);
}

/* As clap/ext/tail.h, which older sets of headers have not. */
const struct { uint32_t(CLAP_ABI *get)(const clap_plugin_t *); } tail = {get_tail};
const clap_plugin_state_t state = {save_state, load_state};
const clap_plugin_latency_t latency = {get_latency};

/* -- the plug-in ------------------------------------------------------------------------------ */

bool CLAP_ABI init(const clap_plugin_t *) { return true; }
bool CLAP_ABI start(const clap_plugin_t *) { return true; }
void CLAP_ABI nothing(const clap_plugin_t *) {}
void CLAP_ABI on_main_thread(const clap_plugin_t *plugin) {
    if (of(plugin).wants_names.exchange(false)) report_names(of(plugin));
    if (of(plugin).wants_values.exchange(false)) rescan(of(plugin));
}

void CLAP_ABI reset(const clap_plugin_t *plugin) { of(plugin).instrument.reset(); }

void CLAP_ABI destroy(const clap_plugin_t *plugin) {
    Plugin *made = &of(plugin);
    close_editor(*made);
    made->~Plugin();
    free(made);
}

bool CLAP_ABI activate(const clap_plugin_t *plugin, double rate, uint32_t, uint32_t) {
    of(plugin).rate = rate;
    return of(plugin).instrument.begin(rate);
}

clap_process_status CLAP_ABI process(const clap_plugin_t *plugin, const clap_process_t *block) {
    Instrument &instrument = of(plugin).instrument;
    if (block->audio_outputs_count == 0 || block->audio_outputs[0].channel_count < 2) return CLAP_PROCESS_ERROR;
    if (const clap_event_transport_t *time = block->transport) {
        const bool counts_in = time->flags & CLAP_TRANSPORT_HAS_SECONDS_TIMELINE && time->song_pos_seconds < 0;
        instrument.transport(time->flags & CLAP_TRANSPORT_IS_PLAYING && !counts_in);
    }
    instrument.begin_block();
    const clap_input_events_t *in = block->in_events;
    for (uint32_t i = 0, count = in ? in->size(in) : 0; i < count; i++) take(instrument, in->get(in, i));
    float **out = block->audio_outputs[0].data32;
    instrument.process(out[0], out[1], block->frames_count);
    report(of(plugin), block->out_events);
    return CLAP_PROCESS_CONTINUE;
}

const void *CLAP_ABI get_extension(const clap_plugin_t *, const char *id) {
    const struct { const char *id; const void *extension; } known[] = {
        {CLAP_EXT_AUDIO_PORTS, &audio_ports}, {CLAP_EXT_PARAMS, &params}, {CLAP_EXT_STATE, &state},
        {CLAP_EXT_LATENCY, &latency},         {"clap.tail", &tail},
    };
    if (const void *extension = note_extension(id)) return extension;
    if (const void *extension = editor_extension(id)) return extension;
    for (const auto &each : known)
        if (!strcmp(id, each.id)) return each.extension;
    return nullptr;
}

const char *features[] = {CLAP_PLUGIN_FEATURE_INSTRUMENT, CLAP_PLUGIN_FEATURE_SYNTHESIZER,
                          CLAP_PLUGIN_FEATURE_STEREO, nullptr};
const clap_plugin_descriptor_t descriptor = {
    CLAP_VERSION, YEHU_IDENTITY, "Yehu", "yehu-server", "", "", "", YEHU_VERSION,
    "A physical model of the yehu, the Chinese two-stringed fiddle", features};

uint32_t CLAP_ABI count_plugins(const clap_plugin_factory_t *) { return 1; }

const clap_plugin_descriptor_t *CLAP_ABI describe(const clap_plugin_factory_t *, uint32_t index) {
    return index == 0 ? &descriptor : nullptr;
}

const clap_plugin_t *CLAP_ABI create(const clap_plugin_factory_t *, const clap_host_t *host, const char *id) {
    if (strcmp(id, YEHU_IDENTITY)) return nullptr;
    void *memory = malloc(sizeof(Plugin));
    if (!memory) return nullptr;
    Plugin *made = new (memory) Plugin{};
    made->host = host;
    made->clap = {&descriptor, made, init, destroy, activate, nothing, start, nothing, reset, process,
                  get_extension, on_main_thread};
    made->held = made->gesture = -1;
    made->named = made->instrument.value(MAPPING);
    return &made->clap;
}

const clap_plugin_factory_t factory = {count_plugins, describe, create};

bool CLAP_ABI open(const char *) { return true; }
void CLAP_ABI close() {}

const void *CLAP_ABI get_factory(const char *id) {
    return strcmp(id, CLAP_PLUGIN_FACTORY_ID) ? nullptr : &factory;
}

} /* namespace */

extern "C" CLAP_EXPORT const clap_plugin_entry_t clap_entry = {CLAP_VERSION, open, close, get_factory};
