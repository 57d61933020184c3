/* The plug-in's window in CLAP hosts. */
#include "clap.hpp"

#include <new>
#include <stdlib.h>
#include <string.h>

#include <clap/ext/gui.h>
#include <clap/ext/params.h>
#include <clap/ext/timer-support.h>

#include "editor.hpp"

namespace yehu {

namespace {
#ifdef _WIN32
constexpr const char *API = CLAP_WINDOW_API_WIN32;
#else
constexpr const char *API = CLAP_WINDOW_API_X11;
#endif

template <class Extension> const Extension *of_host(const Plugin &plugin, const char *id) {
    return (const Extension *)plugin.host->get_extension(plugin.host, id);
}

/* The host hears of it with the next block, or at once where none is played. */
void ask_to_hear(const Plugin &plugin) {
    const auto *shown = of_host<clap_host_params_t>(plugin, CLAP_EXT_PARAMS);
    if (shown && shown->request_flush) shown->request_flush(plugin.host);
}

void edit(void *owner, int parameter, double value) {
    Plugin &plugin = *(Plugin *)owner;
    plugin.instrument.edit(parameter, value);
    ask_to_hear(plugin);
}

void hold(void *owner, int parameter, bool is_held) {
    Plugin &plugin = *(Plugin *)owner;
    plugin.held = is_held ? parameter : -1;
    ask_to_hear(plugin);
}

bool resize(void *owner, int width, int height) {
    const Plugin &plugin = *(Plugin *)owner;
    const auto *window = of_host<clap_host_gui_t>(plugin, CLAP_EXT_GUI);
    return window && window->request_resize(plugin.host, (uint32_t)width, (uint32_t)height);
}

/* A window without a timer would stand still: where the host has to have one, it is asked first. */
bool CLAP_ABI is_supported(const clap_plugin_t *plugin, const char *api, bool is_floating) {
    const bool has_timer = Window::has_timer() || of_host<clap_host_timer_support_t>(of(plugin), CLAP_EXT_TIMER_SUPPORT);
    return !is_floating && !strcmp(api, API) && has_timer;
}

bool CLAP_ABI get_preferred(const clap_plugin_t *, const char **api, bool *is_floating) {
    return *api = API, *is_floating = false, true;
}

bool CLAP_ABI create(const clap_plugin_t *plugin, const char *api, bool is_floating) {
    if (!is_supported(plugin, api, is_floating) || of(plugin).editor) return false;
    void *memory = malloc(sizeof(Editor));
    if (memory) of(plugin).editor = new (memory) Editor(of(plugin).instrument, {&of(plugin), edit, hold, resize});
    return memory != nullptr;
}

void keep_time(Plugin &plugin, bool runs) {
    const auto *timers = Window::has_timer() ? nullptr : of_host<clap_host_timer_support_t>(plugin, CLAP_EXT_TIMER_SUPPORT);
    if (!timers || runs == plugin.has_timer) return;
    if (runs) plugin.has_timer = timers->register_timer(plugin.host, Editor::INTERVAL_MS, &plugin.timer);
    else plugin.has_timer = !timers->unregister_timer(plugin.host, plugin.timer);
}

void CLAP_ABI destroy(const clap_plugin_t *plugin) { close_editor(of(plugin)); }

bool CLAP_ABI set_size(const clap_plugin_t *plugin, uint32_t width, uint32_t height) {
    return of(plugin).editor->set_size((int)width, (int)height), true;
}

bool CLAP_ABI set_scale(const clap_plugin_t *plugin, double scale) {
    return set_size(plugin, (uint32_t)(scale * Editor::WIDTH), (uint32_t)(scale * Editor::HEIGHT));
}

bool CLAP_ABI get_size(const clap_plugin_t *plugin, uint32_t *width, uint32_t *height) {
    const Editor *editor = of(plugin).editor;
    return *width = (uint32_t)editor->width(), *height = (uint32_t)editor->height(), true;
}

bool CLAP_ABI can_resize(const clap_plugin_t *) { return true; }

bool CLAP_ABI get_hints(const clap_plugin_t *, clap_gui_resize_hints_t *hints) {
    hints->can_resize_horizontally = hints->can_resize_vertically = hints->preserve_aspect_ratio = true;
    hints->aspect_ratio_width = Editor::WIDTH, hints->aspect_ratio_height = Editor::HEIGHT;
    return true;
}

bool CLAP_ABI adjust_size(const clap_plugin_t *, uint32_t *width, uint32_t *height) {
    int w = (int)*width, h = (int)*height;
    Editor::fit(&w, &h);
    return *width = (uint32_t)w, *height = (uint32_t)h, true;
}

bool CLAP_ABI set_parent(const clap_plugin_t *plugin, const clap_window_t *window) {
    if (!of(plugin).editor->open((uintptr_t)window->ptr)) return false;
    keep_time(of(plugin), true);
    return true;
}

bool CLAP_ABI set_transient(const clap_plugin_t *, const clap_window_t *) { return false; }
void CLAP_ABI suggest_title(const clap_plugin_t *, const char *) {}

bool CLAP_ABI show(const clap_plugin_t *plugin) {
    of(plugin).editor->show(true);
    return keep_time(of(plugin), true), true;
}

bool CLAP_ABI hide(const clap_plugin_t *plugin) {
    of(plugin).editor->show(false);
    return keep_time(of(plugin), false), true;
}

void CLAP_ABI on_timer(const clap_plugin_t *plugin, clap_id) {
    if (of(plugin).editor) of(plugin).editor->tick();
}

const clap_plugin_gui_t window = {
    is_supported, get_preferred, create,     destroy,       set_scale,     get_size, can_resize, get_hints,
    adjust_size,  set_size,      set_parent, set_transient, suggest_title, show,     hide};
const clap_plugin_timer_support_t timer = {on_timer};
} /* namespace */

const void *editor_extension(const char *id) {
    return !strcmp(id, CLAP_EXT_GUI) ? (const void *)&window : !strcmp(id, CLAP_EXT_TIMER_SUPPORT) ? &timer : nullptr;
}

void close_editor(Plugin &plugin) {
    if (!plugin.editor) return;
    keep_time(plugin, false);
    plugin.editor->~Editor();
    free(plugin.editor);
    plugin.editor = nullptr;
}

} /* namespace yehu */
