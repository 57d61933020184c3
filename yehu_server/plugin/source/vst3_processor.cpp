/* Buses, sound, parameters and events of the VST3 plug-in. */
#include <math.h>
#include <string.h>

#include "vst3.hpp"

namespace yehu {

namespace {

/* -- component -------------------------------------------------------------------------------- */

v3_result V3_API succeed(void *, v3_funknown **) { return V3_OK; }
v3_result V3_API terminate(void *) { return V3_OK; }
v3_result V3_API get_controller(void *, v3_tuid) { return V3_NOT_IMPLEMENTED; } /* this is it */
v3_result V3_API set_io_mode(void *, int32_t) { return V3_NOT_IMPLEMENTED; }

bool is_bus(int32_t media, int32_t direction, int32_t index) {
    return index == 0 && direction == (media == V3_AUDIO ? V3_OUTPUT : V3_INPUT);
}

int32_t V3_API count_buses(void *, int32_t media, int32_t direction) {
    return is_bus(media, direction, 0) ? 1 : 0;
}

v3_result V3_API get_bus(void *, int32_t media, int32_t direction, int32_t index, v3_bus_info *info) {
    if (!is_bus(media, direction, index)) return V3_INVALID_ARG;
    memset(info, 0, sizeof *info);
    info->media_type = media, info->direction = direction;
    info->channel_count = media == V3_AUDIO ? 2 : CHANNELS;
    write_text(media == V3_AUDIO ? "Output" : "Events", info->bus_name);
    info->bus_type = V3_MAIN, info->flags = V3_DEFAULT_ACTIVE;
    return V3_OK;
}

v3_result V3_API get_routing(void *, v3_routing_info *, v3_routing_info *) { return V3_NOT_IMPLEMENTED; }

v3_result V3_API activate_bus(void *, int32_t media, int32_t direction, int32_t index, v3_bool) {
    return is_bus(media, direction, index) ? V3_OK : V3_INVALID_ARG;
}

v3_result V3_API set_active(void *self, v3_bool is_active) {
    Vst3 &plugin = of<COMPONENT>(self);
    return !is_active || plugin.instrument.begin(plugin.rate) ? V3_OK : V3_NOMEM;
}

v3_result V3_API set_state(void *self, v3_bstream **stream) {
    return read_state(of<COMPONENT>(self), stream) ? V3_OK : V3_INVALID_ARG;
}

v3_result V3_API get_state(void *self, v3_bstream **stream) {
    return write_state(of<COMPONENT>(self), stream) ? V3_OK : V3_INTERNAL_ERR;
}

/* -- processor -------------------------------------------------------------------------------- */

constexpr v3_speaker_arrangement STEREO = V3_SPEAKER_L | V3_SPEAKER_R;

v3_result V3_API arrange(void *, v3_speaker_arrangement *, int32_t inputs, v3_speaker_arrangement *out, int32_t outputs) {
    return inputs == 0 && outputs == 1 && out[0] == STEREO ? V3_TRUE : V3_FALSE;
}

v3_result V3_API get_arrangement(void *, int32_t direction, int32_t index, v3_speaker_arrangement *arrangement) {
    if (!is_bus(V3_AUDIO, direction, index)) return V3_INVALID_ARG;
    *arrangement = STEREO;
    return V3_OK;
}

v3_result V3_API can_process(void *, int32_t size) { return size == V3_SAMPLE_32 ? V3_TRUE : V3_FALSE; }

uint32_t V3_API get_latency(void *self) { return (uint32_t)of<PROCESSOR>(self).instrument.latency(); }

v3_result V3_API set_up(void *self, v3_process_setup *setup) {
    Vst3 &plugin = of<PROCESSOR>(self);
    if (setup->symbolic_sample_size != V3_SAMPLE_32) return V3_INVALID_ARG;
    const bool is_ready = plugin.instrument.is_ready() && plugin.rate == setup->sample_rate;
    plugin.rate = setup->sample_rate;
    /* The latency is asked for before the plug-in is active. */
    return is_ready || plugin.instrument.begin(plugin.rate) ? V3_OK : V3_NOMEM;
}

v3_result V3_API set_processing(void *self, v3_bool processes) {
    if (processes) of<PROCESSOR>(self).instrument.reset();
    return V3_OK;
}

void take_midi(Instrument &instrument, uint32_t at, uint32_t number, double unit) {
    const uint8_t channel = (uint8_t)(number / OF_CHANNEL);
    const int which = (int)(number % OF_CHANNEL);
    const uint8_t step = (uint8_t)(127.0 * unit + 0.5);
    if (which == BEND) {
        const int bend = (int)(16383.0 * unit + 0.5);
        const uint8_t bytes[] = {(uint8_t)(0xE0 | channel), (uint8_t)(bend & 127), (uint8_t)(bend >> 7)};
        instrument.midi(at, bytes, sizeof bytes);
    } else if (which == PRESSURE) {
        const uint8_t bytes[] = {(uint8_t)(0xD0 | channel), step};
        instrument.midi(at, bytes, sizeof bytes);
    } else {
        const uint8_t bytes[] = {(uint8_t)(0xB0 | channel), (uint8_t)which, step};
        instrument.midi(at, bytes, sizeof bytes);
    }
}

void take_parameters(Vst3 &plugin, v3_param_changes **changes) {
    Instrument &instrument = plugin.instrument;
    const v3_param_changes *list = v3_cpp_obj(changes);
    for (int32_t i = 0, count = list->get_param_count(changes); i < count; i++) {
        v3_param_value_queue **queue = list->get_param_data(changes, i);
        if (!queue) continue;
        const v3_param_value_queue *points = v3_cpp_obj(queue);
        const uint32_t number = points->get_param_id(queue);
        const int parameter = parameter_of(number);
        if (parameter >= 0) plugin.awaited[parameter] = false;
        for (int32_t n = 0, last = points->get_point_count(queue); n < last; n++) {
            int32_t at;
            double unit;
            if (points->get_point(queue, n, &at, &unit) != V3_OK) continue;
            const uint32_t offset = at > 0 ? (uint32_t)at : 0;
            unit = unit > 0.0 ? unit < 1.0 ? unit : 1.0 : 0.0; /* or no number */
            if (parameter >= 0) instrument.parameter(offset, parameter, from_unit(parameter, unit));
            else if (number < OF_MIDI) take_midi(instrument, offset, number, unit);
        }
    }
}

void take_events(Instrument &instrument, v3_event_list **events) {
    const v3_event_list *list = v3_cpp_obj(events);
    for (uint32_t i = 0, count = list->get_event_count(events); i < count; i++) {
        v3_event event;
        if (list->get_event(events, (int32_t)i, &event) != V3_OK) continue;
        const uint32_t at = event.sample_offset > 0 ? (uint32_t)event.sample_offset : 0;
        if (event.type == V3_EVENT_NOTE_ON) {
            const v3_event_note_on &note = event.note_on;
            /* Hosts make it of MIDI's 7 bits, by which it is the same number again. */
            const double steps = 127.0 * note.velocity, whole = floor(steps + 0.5);
            const double velocity = (fabs(steps - whole) < 1e-4 ? whole : steps) / 127.0;
            if (velocity > 0.0) instrument.note_on(at, note.channel, note.pitch, velocity);
            else instrument.note_off(at, note.channel, note.pitch);
        } else if (event.type == V3_EVENT_NOTE_OFF) {
            instrument.note_off(at, event.note_off.channel, event.note_off.pitch);
        } else if (event.type == V3_EVENT_POLY_PRESSURE) {
            const v3_event_poly_pressure &key = event.poly_pressure;
            const uint8_t bytes[] = {(uint8_t)(0xA0 | (key.channel & 15)), (uint8_t)(key.pitch & 127),
                                     (uint8_t)(127.0f * fminf(fmaxf(key.pressure, 0.0f), 1.0f) + 0.5f)};
            instrument.midi(at, bytes, sizeof bytes);
        }
    }
}

/* Report to the host parameters that moved with another one. */
void report_moved(Instrument &instrument, v3_param_changes **changes) {
    if (!changes || !instrument.has_moved()) return;
    for (int i = 0; i < PARAMETERS; i++) {
        instrument.was_edited(i); /* which its window reports */
        if (!instrument.was_moved(i)) continue;
        v3_param_id number = parameters[i].number;
        int32_t index = 0;
        v3_param_value_queue **queue = v3_cpp_obj(changes)->add_param_data(changes, &number, &index);
        if (queue) v3_cpp_obj(queue)->add_point(queue, 0, to_unit(i, instrument.value(i)), &index);
    }
}

v3_result V3_API process(void *self, v3_process_data *data) {
    Instrument &instrument = of<PROCESSOR>(self).instrument;
    if (data->symbolic_sample_size != V3_SAMPLE_32) return V3_INVALID_ARG;
    if (data->ctx && data->nframes > 0)
        instrument.transport(data->ctx->state & V3_PROCESS_CTX_PLAYING && data->ctx->project_time_in_samples >= 0);
    instrument.begin_block();
    if (data->input_params) take_parameters(of<PROCESSOR>(self), data->input_params);
    if (data->input_events) take_events(instrument, data->input_events);
    if (data->nframes > 0 && data->num_output_buses > 0 && data->outputs[0].num_channels >= 2) {
        float **out = data->outputs[0].channel_buffers_32;
        instrument.process(out[0], out[1], (uint32_t)data->nframes);
        data->outputs[0].channel_silence_bitset = 0;
    }
    report_moved(instrument, data->output_params);
    return V3_OK;
}

uint32_t V3_API get_tail(void *self) {
    const Vst3 &plugin = of<PROCESSOR>(self);
    return (uint32_t)(plugin.instrument.tail_seconds() * plugin.rate);
}

uint32_t V3_API require(void *) { return V3_PROCESS_CTX_NEED_TRANSPORT_STATE; }

} /* namespace */

const v3_component_cpp component = {
    unknown<COMPONENT>(),
    {succeed, terminate},
    {get_controller, set_io_mode, count_buses, get_bus, get_routing, activate_bus, set_active, set_state,
     get_state}};
const v3_audio_processor_cpp processor = {
    unknown<PROCESSOR>(),
    {arrange, get_arrangement, can_process, get_latency, set_up, set_processing, process, get_tail}};
const v3_process_context_requirements_cpp requirements = {unknown<REQUIREMENTS>(), {require}};

} /* namespace yehu */
