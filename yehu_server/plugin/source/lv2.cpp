/* The plug-in for LV2 hosts. Its ports, in order: events, left, right, latency, and the parameters but
 * for the preset, since LV2 has presets of its own, which set ports. So ports hold all of its state.
 */
#include <new>
#include <stdlib.h>
#include <string.h>

#include <lv2/atom/atom.h>
#include <lv2/atom/util.h>
#include <lv2/core/lv2.h>
#include <lv2/midi/midi.h>
#include <lv2/time/time.h>
#include <lv2/urid/urid.h>

#include "instrument.hpp"

namespace {

using namespace yehu;

enum { EVENTS, LEFT, RIGHT, LATENCY, FIRST };
static_assert(PRESET == 0, "the parameters but for the first are ports");

struct Plugin {
    Instrument instrument;
    double rate;
    const LV2_Atom_Sequence *events;
    float *left, *right, *latency;
    const float *ports[PARAMETERS];
    float seen[PARAMETERS]; /* what ports had */
    LV2_URID midi, position, speed, object, blank, number;
};

LV2_Handle instantiate(const LV2_Descriptor *, double rate, const char *, const LV2_Feature *const *features) {
    const LV2_URID_Map *map = nullptr;
    for (; features && *features; features++)
        if (!strcmp((*features)->URI, LV2_URID__map)) map = (const LV2_URID_Map *)(*features)->data;
    void *memory = map ? malloc(sizeof(Plugin)) : nullptr;
    if (!memory) return nullptr;
    Plugin *made = new (memory) Plugin{};
    made->rate = rate;
    for (int i = 0; i < PARAMETERS; i++) made->seen[i] = (float)parameters[i].usual;
    made->midi = map->map(map->handle, LV2_MIDI__MidiEvent);
    made->position = map->map(map->handle, LV2_TIME__Position);
    made->speed = map->map(map->handle, LV2_TIME__speed);
    made->object = map->map(map->handle, LV2_ATOM__Object);
    made->blank = map->map(map->handle, LV2_ATOM__Blank);
    made->number = map->map(map->handle, LV2_ATOM__Float);
    return made;
}

void cleanup(LV2_Handle handle) {
    ((Plugin *)handle)->~Plugin();
    free(handle);
}

void connect(LV2_Handle handle, uint32_t port, void *data) {
    Plugin &plugin = *(Plugin *)handle;
    if (port == EVENTS) plugin.events = (const LV2_Atom_Sequence *)data;
    else if (port == LEFT) plugin.left = (float *)data;
    else if (port == RIGHT) plugin.right = (float *)data;
    else if (port == LATENCY) plugin.latency = (float *)data;
    else if (port - FIRST + 1 < PARAMETERS) plugin.ports[port - FIRST + 1] = (const float *)data;
}

/* Memory is had here; else nothing sounds. */
void activate(LV2_Handle handle) {
    Plugin &plugin = *(Plugin *)handle;
    plugin.instrument.begin(plugin.rate);
}

void follow_transport(Plugin &plugin, const LV2_Atom &atom) {
    const auto *object = (const LV2_Atom_Object *)&atom;
    const LV2_Atom *speed = nullptr;
    if (atom.type != plugin.object && atom.type != plugin.blank) return;
    if (object->body.otype != plugin.position) return;
    lv2_atom_object_get(object, plugin.speed, &speed, 0);
    if (speed && speed->type == plugin.number)
        plugin.instrument.transport(((const LV2_Atom_Float *)speed)->body != 0.0f);
}

void play(Plugin &plugin, const LV2_Atom_Event *event) {
    const uint32_t at = event->time.frames > 0 ? (uint32_t)event->time.frames : 0;
    if (event->body.type == plugin.midi)
        plugin.instrument.midi(at, (const uint8_t *)(event + 1), event->body.size);
}

void run(LV2_Handle handle, uint32_t frames) {
    Plugin &plugin = *(Plugin *)handle;
    Instrument &instrument = plugin.instrument;
    if (plugin.latency) *plugin.latency = (float)instrument.latency();
    if (frames == 0) return;
    if (plugin.events)
        LV2_ATOM_SEQUENCE_FOREACH(plugin.events, event) follow_transport(plugin, event->body);
    instrument.begin_block();
    for (int i = PRESET + 1; i < PARAMETERS; i++)
        if (plugin.ports[i] && *plugin.ports[i] != plugin.seen[i])
            instrument.parameter(0, i, plugin.seen[i] = *plugin.ports[i]);
    if (plugin.events) LV2_ATOM_SEQUENCE_FOREACH(plugin.events, event) play(plugin, event);
    instrument.process(plugin.left, plugin.right, frames);
}

const LV2_Descriptor descriptor = {YEHU_LV2_URI, instantiate, connect, activate, run, nullptr, cleanup, nullptr};

} /* namespace */

extern "C" LV2_SYMBOL_EXPORT const LV2_Descriptor *lv2_descriptor(uint32_t index) {
    return index == 0 ? &descriptor : nullptr;
}
