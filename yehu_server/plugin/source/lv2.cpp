/* The plug-in for LV2 hosts. Its ports, in order: events, left, right, latency, and the parameters but
 * for preset and room, since LV2 has presets of its own, which set ports. So ports hold all of its state.
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
#ifdef YEHU_EDITOR
#include <lv2/instance-access/instance-access.h>
#include <lv2/ui/ui.h>

#include "editor.hpp"
#endif

namespace {

using namespace yehu;

enum { EVENTS, LEFT, RIGHT, LATENCY, FIRST };
static_assert(SETS == 2, "the parameters but for the first are ports");

/* As control-input-port-change-request.h of KXStudio's extensions, which sets of headers have not. */
constexpr const char *REQUESTS = "http://kx.studio/ns/lv2ext/control-input-port-change-request";
struct PortRequest {
    void *handle;
    int (*change)(void *handle, uint32_t port, float value);
};

struct Plugin {
    Instrument instrument;
    double rate;
    const PortRequest *requests; /* or null */
    const LV2_Atom_Sequence *events;
    float *left, *right, *latency;
    const float *ports[PARAMETERS];
    float seen[PARAMETERS]; /* what ports had */
    LV2_URID midi, position, speed, object, blank, number;
};

LV2_Handle instantiate(const LV2_Descriptor *, double rate, const char *, const LV2_Feature *const *features) {
    const LV2_URID_Map *map = nullptr;
    const PortRequest *requests = nullptr;
    for (; features && *features; features++) {
        if (!strcmp((*features)->URI, LV2_URID__map)) map = (const LV2_URID_Map *)(*features)->data;
        if (!strcmp((*features)->URI, REQUESTS)) requests = (const PortRequest *)(*features)->data;
    }
    void *memory = map ? malloc(sizeof(Plugin)) : nullptr;
    if (!memory) return nullptr;
    Plugin *made = new (memory) Plugin{};
    made->rate = rate, made->requests = requests;
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
    else if (port - FIRST + SETS < PARAMETERS) plugin.ports[port - FIRST + SETS] = (const float *)data;
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

/* Ask the host for other values of ports: of parameters that moved with another one. */
void report_moved(const Plugin &plugin, Instrument &instrument) {
    if (!plugin.requests || !instrument.has_moved()) return;
    for (int i = SETS; i < PARAMETERS; i++) {
        if (!instrument.was_moved(i)) continue;
        const float now = (float)instrument.value(i);
        if (plugin.requests->change(plugin.requests->handle, (uint32_t)(FIRST + i - SETS), now) == 0) instrument.know(i, now);
    }
    for (int set = 0; set < SETS; set++) instrument.was_moved(set); /* which are no ports */
}

void run(LV2_Handle handle, uint32_t frames) {
    Plugin &plugin = *(Plugin *)handle;
    Instrument &instrument = plugin.instrument;
    if (plugin.latency) *plugin.latency = (float)instrument.latency();
    if (frames == 0) return;
    if (plugin.events)
        LV2_ATOM_SEQUENCE_FOREACH(plugin.events, event) follow_transport(plugin, event->body);
    instrument.begin_block();
    for (int i = SETS; i < PARAMETERS; i++)
        if (plugin.ports[i] && *plugin.ports[i] != plugin.seen[i])
            instrument.parameter(0, i, plugin.seen[i] = *plugin.ports[i]);
    if (plugin.events) LV2_ATOM_SEQUENCE_FOREACH(plugin.events, event) play(plugin, event);
    instrument.process(plugin.left, plugin.right, frames);
    report_moved(plugin, instrument);
}

const LV2_Descriptor descriptor = {YEHU_LV2_URI, instantiate, connect, activate, run, nullptr, cleanup, nullptr};

#ifdef YEHU_EDITOR
/* -- its window, in the host's process: it sees the instrument, and writes ports ---------------- */

struct Ui {
    Instrument *instrument;
    LV2UI_Write_Function write;
    LV2UI_Controller controller;
    const LV2UI_Resize *resize;
    const LV2UI_Touch *touch;
    Editor editor;
};

void edit(void *owner, int parameter, double value) {
    Ui &ui = *(Ui *)owner;
    ui.instrument->edit(parameter, value);
    for (int i = SETS; i < PARAMETERS; i++) {
        const float now = (float)ui.instrument->value(i);
        const bool is_edited = ui.instrument->was_edited(i);
        if (ui.instrument->was_moved(i) || is_edited) ui.write(ui.controller, (uint32_t)(FIRST + i - SETS), sizeof now, 0, &now);
    }
}

void hold(void *owner, int parameter, bool is_held) {
    const Ui &ui = *(Ui *)owner;
    if (ui.touch) ui.touch->touch(ui.touch->handle, (uint32_t)(FIRST + parameter - SETS), is_held);
}

bool resize(void *owner, int width, int height) {
    const Ui &ui = *(Ui *)owner;
    return ui.resize && ui.resize->ui_resize(ui.resize->handle, width, height) == 0;
}

LV2UI_Handle open_ui(const LV2UI_Descriptor *, const char *, const char *, LV2UI_Write_Function write,
                     LV2UI_Controller controller, LV2UI_Widget *widget, const LV2_Feature *const *features) {
    void *parent = nullptr;
    Plugin *plugin = nullptr;
    const LV2UI_Resize *resizes = nullptr;
    const LV2UI_Touch *touch = nullptr;
    for (; features && *features; features++) {
        if (!strcmp((*features)->URI, LV2_UI__parent)) parent = (*features)->data;
        if (!strcmp((*features)->URI, LV2_INSTANCE_ACCESS_URI)) plugin = (Plugin *)(*features)->data;
        if (!strcmp((*features)->URI, LV2_UI__touch)) touch = (const LV2UI_Touch *)(*features)->data;
        if (!strcmp((*features)->URI, LV2_UI__resize)) resizes = (const LV2UI_Resize *)(*features)->data;
    }
    void *memory = parent && plugin ? malloc(sizeof(Ui)) : nullptr;
    if (!memory) return nullptr;
    Ui *made = new (memory) Ui{&plugin->instrument, write, controller, resizes, touch, {plugin->instrument, {memory, edit, hold, resize}}};
    if (!made->editor.open((uintptr_t)parent)) return made->~Ui(), free(memory), nullptr;
    if (resizes) resizes->ui_resize(resizes->handle, made->editor.width(), made->editor.height());
    *widget = (LV2UI_Widget)made->editor.handle();
    return made;
}

void close_ui(LV2UI_Handle handle) {
    ((Ui *)handle)->~Ui();
    free(handle);
}

int idle(LV2UI_Handle handle) { return ((Ui *)handle)->editor.tick(), 0; }

int set_size(LV2UI_Feature_Handle handle, int width, int height) {
    return ((Ui *)handle)->editor.set_size(width, height), 0;
}

const void *extension(const char *id) {
    static const LV2UI_Idle_Interface idles = {idle};
    static const LV2UI_Resize sizes = {nullptr, set_size};
    return !strcmp(id, LV2_UI__idleInterface) ? (const void *)&idles : !strcmp(id, LV2_UI__resize) ? &sizes : nullptr;
}

void port_event(LV2UI_Handle, uint32_t, uint32_t, uint32_t, const void *) {} /* the instrument is seen itself */

const LV2UI_Descriptor ui_descriptor = {YEHU_LV2_URI "#window", open_ui, close_ui, port_event, extension};
#endif

} /* namespace */

#ifdef YEHU_EDITOR
extern "C" LV2_SYMBOL_EXPORT const LV2UI_Descriptor *lv2ui_descriptor(uint32_t index) {
    return index == 0 ? &ui_descriptor : nullptr;
}
#endif

extern "C" LV2_SYMBOL_EXPORT const LV2_Descriptor *lv2_descriptor(uint32_t index) {
    return index == 0 ? &descriptor : nullptr;
}
