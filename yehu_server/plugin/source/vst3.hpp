/* The plug-in for VST3 hosts: one object with several interfaces, each a table of functions. A host
 * has pointers to the places of those tables in the object.
 */
#ifndef YEHU_VST3_HPP
#define YEHU_VST3_HPP

#include <atomic>
#include <stdint.h>

#include <travesty/audio_processor.h>
#include <travesty/component.h>
#include <travesty/edit_controller.h>
#include <travesty/factory.h>
#include <travesty/unit.h>

#include "instrument.hpp"

namespace yehu {

enum { COMPONENT, PROCESSOR, REQUIREMENTS, CONTROLLER, CONTROLLERS_OF_MIDI, UNITS, KEY_SWITCHES, INTERFACES };

struct Vst3 {
    const void *tables[INTERFACES]; /* first: see `of` */
    std::atomic<uint32_t> references;
    double rate;
    Settings shown; /* what the host set the controller to */
    bool unread[PARAMETERS]; /* whether it was changed since by something else */
    std::atomic<bool> awaited[PARAMETERS]; /* whether the processor has not got it yet */
    v3_component_handler **handler; /* of the host; or null */
    Instrument instrument;
};

extern const v3_component_cpp component;
extern const v3_audio_processor_cpp processor;
extern const v3_process_context_requirements_cpp requirements;
extern const v3_edit_controller_cpp controller;
extern const v3_midi_mapping_cpp controllers_of_midi;
extern const v3_unit_information_cpp units;

/* IKeyswitchController. */
struct KeySwitch {
    uint32_t type;
    v3_str_128 title, short_title;
    int32_t lowest, highest, remapped, unit, flags;
};
struct KeySwitches : v3_funknown {
    int32_t(V3_API *count)(void *self, int32_t bus, int16_t channel);
    v3_result(V3_API *get)(void *self, int32_t bus, int16_t channel, int32_t index, KeySwitch *info);
};
extern const v3_tuid key_switches_iid;
extern const KeySwitches key_switches;
/* The key that chooses the first articulation by the mapping that is shown, or -1, and how many do. */
int first_switch(const Vst3 &plugin);
int switch_count(const Vst3 &plugin);

template <int place> Vst3 &of(void *self) {
    return *(Vst3 *)((const void **)self - place);
}

/* Of any interface: those of the first lead to the others. */
v3_result query(Vst3 &plugin, const v3_tuid id, void **into);
uint32_t unref(Vst3 &plugin);

template <int place> v3_result V3_API query_interface(void *self, const v3_tuid id, void **into) {
    return query(of<place>(self), id, into);
}
template <int place> uint32_t V3_API ref(void *self) { return ++of<place>(self).references; }
template <int place> uint32_t V3_API unref(void *self) { return unref(of<place>(self)); }
template <int place> constexpr v3_funknown unknown() {
    return {query_interface<place>, ref<place>, unref<place>};
}

/* Controllers of MIDI are parameters, too: by channel, the 128 control changes, pressure, bend. */
enum { PRESSURE = 128, BEND = 129, OF_CHANNEL = 130, CHANNELS = 16, OF_MIDI = OF_CHANNEL * CHANNELS };

#ifdef YEHU_EDITOR
v3_plugin_view **make_view(Vst3 &plugin);
#else
inline v3_plugin_view **make_view(Vst3 &) { return nullptr; }
#endif

void write_text(const char *text, int16_t *into); /* into a v3_str_128 */
/* From the host's main thread: change what is shown, and report what moves with it. */
void show(Vst3 &plugin, int parameter, double value);
bool read_state(Vst3 &plugin, v3_bstream **stream);
bool write_state(const Vst3 &plugin, v3_bstream **stream);

} /* namespace yehu */

#endif
