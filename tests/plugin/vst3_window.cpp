/* A small VST3 host: opens the plug-in's window, chooses the next preset in it, scales and closes it.
 *
 *     vst3_window LIBRARY X Y     where to press
 *
 * Prints timers while it is open and after, edits that were reported to it, the number and the value of the
 * last, the value that the controller shows, the width of the inner window, and flags of restarts.
 */
#include <dlfcn.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <travesty/component.h>
#include <travesty/edit_controller.h>
#include <travesty/factory.h>
#include <travesty/view.h>
#include <xcb/xcb.h>

namespace {
int timers, edits, begun, ended, restarted, waited;
v3_timer_handler **timer;
v3_event_handler **waiting;
v3_param_id edited;
double value;

v3_result V3_API query(void *self, const v3_tuid id, void **into);
uint32_t V3_API stay(void *) { return 1; }
const v3_funknown unknown = {query, stay, stay};

v3_result V3_API wait(void *, v3_event_handler **handler, int file) { return waiting = handler, waited = file, V3_OK; }
v3_result V3_API forget(void *, v3_event_handler **) { return waiting = nullptr, V3_OK; }
v3_result V3_API start(void *, v3_timer_handler **handler, uint64_t) { return timers++, timer = handler, V3_OK; }
v3_result V3_API stop(void *, v3_timer_handler **) { return timers--, V3_OK; }
v3_result V3_API resize(void *, v3_plugin_view **, v3_view_rect *) { return V3_FALSE; }
v3_result V3_API begin(void *, v3_param_id) { return begun++, V3_OK; }
v3_result V3_API end(void *, v3_param_id) { return ended++, V3_OK; }
v3_result V3_API perform(void *, v3_param_id id, double to) { return edits++, edited = id, value = to, V3_OK; }
v3_result V3_API restart(void *, int32_t flags) { return restarted |= flags, V3_OK; }

const v3_run_loop_cpp loop_table = {unknown, {wait, forget, start, stop}};
const v3_plugin_frame_cpp frame_table = {unknown, {resize}};
const struct { v3_funknown unknown; v3_component_handler edits; } handler_table = {unknown, {begin, perform, end, restart}};
const void *loop = &loop_table, *frame = &frame_table, *handler = &handler_table;

v3_result V3_API query(void *, const v3_tuid id, void **into) {
    if (!v3_tuid_match(id, v3_run_loop_iid)) return *into = nullptr, V3_NO_INTERFACE;
    return *into = &loop, V3_OK;
}
} /* namespace */

int main(int words, char **word) {
    if (words != 4) return 2;
    void *library = dlopen(word[1], RTLD_NOW | RTLD_LOCAL);
    auto *get = library ? (v3_plugin_factory **(*)())dlsym(library, "GetPluginFactory") : nullptr;
    if (!get) return 3;
    v3_plugin_factory **factory = get();
    v3_class_info info;
    v3_edit_controller **controller = nullptr;
    v3_cpp_obj(factory)->get_class_info(factory, 0, &info);
    v3_cpp_obj(factory)->create_instance(factory, info.class_id, v3_edit_controller_iid, (void **)&controller);
    if (!controller) return 4;
    v3_cpp_obj(controller)->set_component_handler(controller, (v3_component_handler **)&handler);
    v3_plugin_view **view = v3_cpp_obj(controller)->create_view(controller, "editor");
    v3_view_rect size = {};
    if (!view || v3_cpp_obj(view)->get_size(view, &size) != V3_OK) return 5;
    xcb_connection_t *x = xcb_connect(nullptr, nullptr);
    if (xcb_connection_has_error(x)) return 6;
    const auto settle = [x] { free(xcb_get_input_focus_reply(x, xcb_get_input_focus(x), nullptr)); };
    const xcb_screen_t *screen = xcb_setup_roots_iterator(xcb_get_setup(x)).data;
    const xcb_window_t window = xcb_generate_id(x);
    xcb_create_window(x, XCB_COPY_FROM_PARENT, window, screen->root, 0, 0, (uint16_t)size.right, (uint16_t)size.bottom,
                      0, XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual, 0, nullptr);
    xcb_map_window(x, window);
    settle();
    v3_cpp_obj(view)->set_frame(view, (v3_plugin_frame **)&frame);
    if (v3_cpp_obj(view)->attached(view, (void *)(uintptr_t)window, V3_VIEW_PLATFORM_TYPE_X11) != V3_OK) return 7;
    const int open_timers = timers;
    v3_cpp_obj(timer)->on_timer(timer);
    if (!waiting) return 9;
    xcb_query_tree_reply_t *tree = xcb_query_tree_reply(x, xcb_query_tree(x, window), nullptr);
    const xcb_window_t inner = xcb_query_tree_children(tree)[0];
    xcb_button_press_event_t event = {};
    event.response_type = XCB_BUTTON_PRESS, event.detail = 1, event.event = inner;
    event.event_x = (int16_t)atoi(word[2]), event.event_y = (int16_t)atoi(word[3]);
    xcb_send_event(x, 0, inner, XCB_EVENT_MASK_NO_EVENT, (const char *)&event);
    settle();
    for (int tries = 0; tries < 100 && edits == 0; tries++) { /* as a host without time for timers */
        pollfd file = {waited, POLLIN, 0};
        if (poll(&file, 1, 100) > 0) v3_cpp_obj(waiting)->on_fd_is_set(waiting, waited);
    }
    size = {0, 0, 1020, 900};
    v3_cpp_obj(view)->check_size_constraint(view, &size);
    v3_cpp_obj(view)->on_size(view, &size);
    v3_cpp_obj(timer)->on_timer(timer);
    int width = 0;
    for (int tries = 0; tries < 100 && width != size.right; tries++) {
        xcb_get_geometry_reply_t *geometry = xcb_get_geometry_reply(x, xcb_get_geometry(x, inner), nullptr);
        width = geometry ? geometry->width : 0;
        free(geometry);
    }
    const int held = begun - ended;
    v3_cpp_obj(view)->removed(view);
    if (waiting) return 8;
    v3_cpp_obj_unref(view);
    printf("%d %d %d %u %g %g %d %d %d %d\n", open_timers, timers, edits, edited, value,
           v3_cpp_obj(controller)->get_parameter_normalised(controller, edited), width, restarted, held, begun - ended);
    v3_cpp_obj_unref(controller);
    free(tree);
    xcb_disconnect(x);
    return 0;
}
