/* Parameters of the VST3 plug-in as the host shows them, its programs, and which are of MIDI. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vst3.hpp"

namespace yehu {

namespace {

constexpr int PROGRAMS = 1; /* number of the list */

/* The number of a parameter's group, from 1; a host's units are these, and 0 for all. */
int group_of(int parameter, int groups[PARAMETERS]) {
    int count = 0;
    for (int i = 0; i < PARAMETERS; i++) {
        int known = 0;
        for (int before = 0; before < i && !known; before++)
            if (!strcmp(parameters[before].group, parameters[i].group)) known = groups[before];
        groups[i] = known ? known : ++count;
    }
    return parameter < 0 ? count : groups[parameter];
}

void read_text(const int16_t *text, char *into, size_t size) {
    size_t at = 0;
    for (; text[at] && at + 1 < size; at++) into[at] = text[at] < 128 ? (char)text[at] : '?';
    into[at] = 0;
}

v3_result V3_API initialize(void *, v3_funknown **) { return V3_OK; }
v3_result V3_API terminate(void *) { return V3_OK; }

/* The state of the component is that of the controller. */
v3_result V3_API follow_component(void *self, v3_bstream **) {
    of<CONTROLLER>(self).shown.copy(of<CONTROLLER>(self).instrument.all());
    return V3_OK;
}

v3_result V3_API no_state(void *, v3_bstream **) { return V3_NOT_IMPLEMENTED; }

int32_t V3_API count(void *) { return PARAMETERS + OF_MIDI; }

v3_result V3_API get_info(void *, int32_t index, v3_param_info *info) {
    if (index < 0 || index >= PARAMETERS + OF_MIDI) return V3_INVALID_ARG;
    memset(info, 0, sizeof *info);
    if (index >= PARAMETERS) {
        const int number = index - PARAMETERS, which = number % OF_CHANNEL;
        char name[64];
        /* So they begin in most plug-ins: hosts for programs leave out what does. */
        snprintf(name, sizeof name, "MIDI CC %d|%d", number / OF_CHANNEL + 1, which);
        info->param_id = (v3_param_id)number;
        info->default_normalised_value = which == BEND ? 0.5 : 0.0;
        info->flags = V3_PARAM_CAN_AUTOMATE | V3_PARAM_IS_HIDDEN;
        write_text(name, info->title);
        return V3_OK;
    }
    const Parameter &p = parameters[index];
    int groups[PARAMETERS];
    info->param_id = p.number;
    write_text(p.name, info->title);
    write_text(p.name, info->short_title);
    write_text(p.unit, info->units);
    info->step_count = p.steps;
    info->default_normalised_value = to_unit(index, p.usual);
    info->unit_id = index == PRESET ? 0 : group_of(index, groups);
    info->flags = V3_PARAM_CAN_AUTOMATE | (p.choices ? V3_PARAM_IS_LIST : 0);
    if (index == PRESET) info->flags |= V3_PARAM_PROGRAM_CHANGE;
    return V3_OK;
}

v3_result V3_API to_text(void *self, v3_param_id number, double unit, v3_str_128 text) {
    const int parameter = parameter_of(number);
    char written[64];
    if (parameter >= 0)
        of<CONTROLLER>(self).shown.write(parameter, from_unit(parameter, unit), written, sizeof written);
    else snprintf(written, sizeof written, "%.0f", 127.0 * unit);
    write_text(written, text);
    return V3_OK;
}

v3_result V3_API from_text(void *, v3_param_id number, int16_t *text, double *unit) {
    const int parameter = parameter_of(number);
    char read[64];
    double value;
    read_text(text, read, sizeof read);
    if (parameter < 0 || !Settings::read(parameter, read, &value)) return V3_FALSE;
    *unit = to_unit(parameter, value);
    return V3_OK;
}

double V3_API to_plain(void *, v3_param_id number, double unit) {
    const int parameter = parameter_of(number);
    return parameter < 0 ? unit : from_unit(parameter, unit);
}

double V3_API to_normalised(void *, v3_param_id number, double value) {
    const int parameter = parameter_of(number);
    return parameter < 0 ? value : to_unit(parameter, value);
}

double V3_API get(void *self, v3_param_id number) {
    const int parameter = parameter_of(number);
    if (parameter < 0) return number % OF_CHANNEL == BEND ? 0.5 : 0.0;
    Vst3 &plugin = of<CONTROLLER>(self);
    const double value = plugin.shown.value(parameter);
    if (plugin.unread[parameter]) plugin.instrument.know(parameter, value);
    plugin.unread[parameter] = false;
    return to_unit(parameter, value);
}

/* Only what is shown: the host sets the processor, at the frame. */
v3_result V3_API set(void *self, v3_param_id number, double unit) {
    const int parameter = parameter_of(number);
    if (parameter < 0) return number < OF_MIDI ? V3_OK : V3_INVALID_ARG;
    Vst3 &plugin = of<CONTROLLER>(self);
    const double value = from_unit(parameter, unit);
    plugin.unread[parameter] = false;
    /* It may be what the processor reported. */
    const bool is_processed = is_same(parameter, value, plugin.instrument.value(parameter));
    if (is_processed) plugin.instrument.know(parameter, value);
    plugin.awaited[parameter] = !is_processed;
    show(plugin, parameter, value);
    return V3_OK;
}


v3_result V3_API set_handler(void *self, v3_component_handler **handler) {
    Vst3 &plugin = of<CONTROLLER>(self);
    if (handler) v3_cpp_obj_ref(handler);
    if (plugin.handler) v3_cpp_obj_unref(plugin.handler);
    plugin.handler = handler;
    return V3_OK;
}

v3_plugin_view **V3_API create_view(void *self, const char *name) {
    return strcmp(name, "editor") ? nullptr : make_view(of<CONTROLLER>(self));
}

v3_result V3_API assign(void *, int32_t bus, int16_t channel, int16_t which, v3_param_id *number) {
    if (bus != 0 || channel < 0 || channel >= CHANNELS || which < 0 || which >= OF_CHANNEL) return V3_FALSE;
    *number = (v3_param_id)(channel * OF_CHANNEL + which);
    return V3_TRUE;
}

/* -- units and programs ----------------------------------------------------------------------- */

int32_t V3_API count_units(void *) {
    int groups[PARAMETERS];
    return 1 + group_of(-1, groups);
}

v3_result V3_API get_unit(void *, int32_t index, v3_unit_info *info) {
    int groups[PARAMETERS];
    if (index < 0 || index > group_of(-1, groups)) return V3_INVALID_ARG;
    memset(info, 0, sizeof *info);
    info->id = index, info->parent_unit_id = index == 0 ? -1 : 0;
    info->program_list_id = index == 0 ? PROGRAMS : -1;
    const char *name = "Yehu";
    for (int i = PARAMETERS - 1; i >= 0; i--)
        if (groups[i] == index) name = parameters[i].group;
    write_text(name, info->name);
    return V3_OK;
}

int32_t V3_API count_lists(void *) { return 1; }

v3_result V3_API get_list(void *, int32_t index, v3_program_list_info *info) {
    if (index != 0) return V3_INVALID_ARG;
    info->id = PROGRAMS, info->programCount = parameters[PRESET].steps + 1;
    write_text(parameters[PRESET].name, info->name);
    return V3_OK;
}

bool is_program(int32_t list, int32_t index) { return list == PROGRAMS && index >= 0 && index <= parameters[PRESET].steps; }

v3_result V3_API get_program(void *, int32_t list, int32_t index, v3_str_128 name) {
    if (!is_program(list, index)) return V3_INVALID_ARG;
    write_text(parameters[PRESET].choices[index], name);
    return V3_OK;
}

v3_result V3_API get_program_info(void *, int32_t, int32_t, const char *, v3_str_128) { return V3_NOT_IMPLEMENTED; }

v3_result V3_API has_pitch_names(void *self, int32_t list, int32_t index) {
    return is_program(list, index) && switch_count(of<UNITS>(self)) > 0 ? V3_TRUE : V3_FALSE;
}

v3_result V3_API get_pitch_name(void *self, int32_t list, int32_t index, int16_t key, v3_str_128 name) {
    const int articulation = key - first_switch(of<UNITS>(self));
    if (!is_program(list, index) || articulation < 0 || articulation >= switch_count(of<UNITS>(self))) return V3_FALSE;
    return write_text(parameters[ARTICULATION].choices[articulation], name), V3_OK;
}

int32_t V3_API get_selected(void *) { return 0; }
v3_result V3_API select(void *, int32_t) { return V3_OK; }

v3_result V3_API get_by_bus(void *, int32_t, int32_t, int32_t bus, int32_t, int32_t *unit) {
    *unit = 0;
    return bus == 0 ? V3_OK : V3_FALSE;
}

v3_result V3_API set_program(void *, int32_t, int32_t, v3_bstream **) { return V3_NOT_IMPLEMENTED; }

/* As ivstunits.h and ivsteditcontroller.h, of which sets of headers have not all. */
constexpr int32_t KEY_SWITCHES_CHANGED = 1 << 10, ALL_PROGRAMS = -1;
const v3_tuid unit_handler_iid = V3_ID(0x4B5147F8, 0x4654486B, 0x8DAB30BA, 0x163A3C56);
struct UnitHandler : v3_funknown {
    v3_result(V3_API *select)(void *self, int32_t unit);
    v3_result(V3_API *change)(void *self, int32_t list, int32_t program);
};

/* Keys have other names. */
void report_names(const Vst3 &plugin) {
    UnitHandler **handler = nullptr;
    v3_cpp_obj_query_interface(plugin.handler, unit_handler_iid, &handler);
    if (!handler) return;
    (*handler)->change(handler, PROGRAMS, ALL_PROGRAMS);
    (*handler)->unref(handler);
}

} /* namespace */

/* As the standard wants it of a parameter that changes programs: what moves with it is not written by
 * the plug-in but read by the host. */
void show(Vst3 &plugin, int parameter, double value) {
    int32_t flags = 0;
    const int first = first_switch(plugin);
    plugin.shown.change(parameter, value, [&](int each, bool is_other) {
        if (each == parameter || !is_other) return;
        plugin.unread[each] = true;
        flags |= V3_RESTART_PARAM_VALUES_CHANGED;
    });
    const bool has_other_keys = first != first_switch(plugin);
    if (has_other_keys) flags |= KEY_SWITCHES_CHANGED;
    if (has_other_keys && plugin.handler) report_names(plugin);
    if (flags && plugin.handler) v3_cpp_obj(plugin.handler)->restart_component(plugin.handler, flags);
}

const v3_edit_controller_cpp controller = {
    unknown<CONTROLLER>(),
    {initialize, terminate},
    {follow_component, no_state, no_state, count, get_info, to_text, from_text, to_plain, to_normalised,
     get, set, set_handler, create_view}};
const v3_midi_mapping_cpp controllers_of_midi = {unknown<CONTROLLERS_OF_MIDI>(), {assign}};
const v3_unit_information_cpp units = {
    unknown<UNITS>(),
    {count_units, get_unit, count_lists, get_list, get_program, get_program_info, has_pitch_names,
     get_pitch_name, get_selected, select, get_by_bus, set_program}};

} /* namespace yehu */
