/* The plug-in's window in VST3 hosts: an object of its own, which has several interfaces. */
#include "vst3.hpp"

#include <new>
#include <stdlib.h>
#include <string.h>

#include <travesty/view.h>

#include "editor.hpp"

namespace yehu {

namespace {

enum { VIEW, SCALING, TIMER, EVENTS, PLACES };

struct View {
    const void *tables[PLACES]; /* first: see `viewed` */
    std::atomic<uint32_t> references;
    Vst3 *plugin;
    v3_plugin_frame **frame;
    v3_run_loop **loop;
    int held; /* the parameter whose slider is held, or -1 */
    Editor editor;
};

template <int place> View &viewed(void *self) { return *(View *)((const void **)self - place); }

void stop(View &view) {
    if (!view.loop) return;
    v3_cpp_obj(view.loop)->unregister_timer(view.loop, (v3_timer_handler **)&view.tables[TIMER]);
    v3_cpp_obj(view.loop)->unregister_event_handler(view.loop, (v3_event_handler **)&view.tables[EVENTS]);
    v3_cpp_obj_unref(view.loop);
    view.loop = nullptr;
}

template <int place> v3_result V3_API query_view(void *self, const v3_tuid id, void **into) {
    View &view = viewed<place>(self);
    const struct { const uint8_t *id; int at; } known[] = {
        {v3_funknown_iid, VIEW}, {v3_plugin_view_iid, VIEW}, {v3_plugin_view_content_scale_iid, SCALING},
        {v3_timer_handler_iid, TIMER}, {v3_event_handler_iid, EVENTS}};
    for (const auto &each : known)
        if (v3_tuid_match(each.id, id)) {
            view.references++;
            *into = &view.tables[each.at];
            return V3_OK;
        }
    *into = nullptr;
    return V3_NO_INTERFACE;
}

template <int place> uint32_t V3_API ref_view(void *self) { return ++viewed<place>(self).references; }

template <int place> uint32_t V3_API unref_view(void *self) {
    View &view = viewed<place>(self);
    const uint32_t left = --view.references;
    if (left > 0) return left;
    stop(view);
    Vst3 &plugin = *view.plugin;
    view.~View();
    free(&view);
    unref(plugin);
    return 0;
}

template <int place> constexpr v3_funknown unknown_view() {
    return {query_view<place>, ref_view<place>, unref_view<place>};
}

v3_result V3_API is_supported(void *, const char *kind) {
    return strcmp(kind, V3_VIEW_PLATFORM_TYPE_NATIVE) ? V3_FALSE : V3_TRUE;
}

v3_result V3_API attached(void *self, void *parent, const char *kind) {
    View &view = viewed<VIEW>(self);
    if (is_supported(self, kind) != V3_TRUE) return V3_INVALID_ARG;
    if (!Window::has_timer() && view.frame)
        v3_cpp_obj_query_interface(view.frame, v3_run_loop_iid, &view.loop);
    if ((!Window::has_timer() && !view.loop) || !view.editor.open((uintptr_t)parent)) return V3_FALSE;
    if (!view.loop) return V3_OK;
    v3_cpp_obj(view.loop)->register_timer(view.loop, (v3_timer_handler **)&view.tables[TIMER], Editor::INTERVAL_MS);
    /* Some hosts (DawDreamer) have no time for timers. */
    v3_cpp_obj(view.loop)->register_event_handler(view.loop, (v3_event_handler **)&view.tables[EVENTS], view.editor.file());
    return V3_OK;
}

v3_result V3_API removed(void *self) {
    View &view = viewed<VIEW>(self);
    stop(view);
    view.editor.close();
    return V3_OK;
}

v3_result V3_API on_wheel(void *, float) { return V3_FALSE; }
v3_result V3_API on_key(void *, int16_t, int16_t, int16_t) { return V3_FALSE; } /* its window has them */
v3_result V3_API on_focus(void *, v3_bool) { return V3_OK; }

v3_result V3_API get_size(void *self, v3_view_rect *size) {
    const Editor &editor = viewed<VIEW>(self).editor;
    *size = {0, 0, editor.width(), editor.height()};
    return V3_OK;
}

v3_result V3_API on_size(void *self, v3_view_rect *size) {
    viewed<VIEW>(self).editor.set_size(size->right - size->left, size->bottom - size->top);
    return V3_OK;
}

v3_result V3_API set_frame(void *self, v3_plugin_frame **frame) {
    viewed<VIEW>(self).frame = frame;
    return V3_OK;
}

v3_result V3_API can_resize(void *) { return V3_TRUE; }

v3_result V3_API constrain(void *, v3_view_rect *size) {
    int width = size->right - size->left, height = size->bottom - size->top;
    Editor::fit(&width, &height);
    size->right = size->left + width, size->bottom = size->top + height;
    return V3_TRUE;
}

v3_result V3_API set_scale(void *self, float scale) {
    viewed<SCALING>(self).editor.set_size((int)(scale * Editor::WIDTH), (int)(scale * Editor::HEIGHT));
    return V3_OK;
}

void V3_API on_timer(void *self) { viewed<TIMER>(self).editor.tick(); }
void V3_API on_event(void *self, int) { viewed<EVENTS>(self).editor.tick(); }

void hold(void *owner, int parameter, bool is_held) {
    View &view = *(View *)owner;
    v3_component_handler **handler = view.plugin->handler;
    view.held = is_held ? parameter : -1;
    if (!handler) return;
    if (is_held) v3_cpp_obj(handler)->begin_edit(handler, parameters[parameter].number);
    else v3_cpp_obj(handler)->end_edit(handler, parameters[parameter].number);
}

/* The host sets the processor, too. */
void edit(void *owner, int parameter, double value) {
    const bool is_gesture = ((View *)owner)->held != parameter;
    Vst3 &plugin = *((View *)owner)->plugin;
    const uint32_t number = parameters[parameter].number;
    plugin.instrument.edit(parameter, value);
    if (plugin.handler) {
        if (is_gesture) v3_cpp_obj(plugin.handler)->begin_edit(plugin.handler, number);
        v3_cpp_obj(plugin.handler)->perform_edit(plugin.handler, number, to_unit(parameter, value));
        if (is_gesture) v3_cpp_obj(plugin.handler)->end_edit(plugin.handler, number);
    }
    show(plugin, parameter, value);
}

bool resize(void *owner, int width, int height) {
    View &view = *(View *)owner;
    v3_view_rect size = {0, 0, width, height};
    return view.frame && v3_cpp_obj(view.frame)->resize_view(view.frame, (v3_plugin_view **)&view.tables[VIEW], &size) == V3_OK;
}

const v3_plugin_view_cpp view_table = {
    unknown_view<VIEW>(),
    {is_supported, attached, removed, on_wheel, on_key, on_key, get_size, on_size, on_focus, set_frame, can_resize,
     constrain}};
const v3_plugin_view_content_scale_cpp scaling = {unknown_view<SCALING>(), {set_scale}};
const v3_timer_handler_cpp timer = {unknown_view<TIMER>(), {on_timer}};
const v3_event_handler_cpp events = {unknown_view<EVENTS>(), {on_event}};

} /* namespace */

v3_plugin_view **make_view(Vst3 &plugin) {
    void *memory = malloc(sizeof(View));
    if (!memory) return nullptr;
    View *made = new (memory) View{{&view_table, &scaling, &timer, &events}, {1}, &plugin, nullptr, nullptr, -1,
                                   {plugin.instrument, {memory, edit, hold, resize}}};
    plugin.references++;
    return (v3_plugin_view **)&made->tables[VIEW];
}

} /* namespace yehu */
