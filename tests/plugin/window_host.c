/* A small CLAP host with a window: plays a note, and does what it reads from its input.
 *
 *     window_host PLUGIN
 *
 *     open                 show the plug-in's window in one of its own
 *     close                and no more
 *     play BLOCKS          process blocks of 256 frames, of an A4 that is held
 *     begin BLOCKS         the same on a thread of its own, until
 *     end                  all are played
 *     state                save it, and load it again
 *     tick                 its timer is due
 *     click X Y            and press: events as of a user, of the first button and of a key
 *     drag X Y             the same button, pressed
 *     release
 *     key CODE
 *     size WIDTH HEIGHT    what becomes of a size that is asked for
 *     shot FILE            the pixels of the window, as a PPM
 *     value NUMBER         of a parameter
 *     timers               how many the plug-in has
 *
 * Answers each with a line.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <clap/entry.h>
#include <clap/ext/gui.h>
#include <clap/ext/params.h>
#include <clap/ext/state.h>
#include <clap/ext/timer-support.h>
#include <clap/plugin-factory.h>
#include <dlfcn.h>
#include <pthread.h>
#include <xcb/xcb.h>

static const clap_plugin_t *plugin;
static int timers, asked[2];
static _Atomic int edits, gestures[2]; /* begun and ended */
static xcb_connection_t *x;
static xcb_window_t window;

static bool CLAP_ABI start(const clap_host_t *host, uint32_t ms, clap_id *id) {
    return (void)host, (void)ms, timers++, *id = 7, true;
}
static bool CLAP_ABI stop(const clap_host_t *host, clap_id id) { return (void)host, timers--, id == 7; }
static void CLAP_ABI nothing(const clap_host_t *host) { (void)host; }
static void CLAP_ABI closed(const clap_host_t *host, bool is_gone) { (void)host, (void)is_gone; }
static void CLAP_ABI rescan(const clap_host_t *host, clap_param_rescan_flags flags) { (void)host, (void)flags; }
static void CLAP_ABI forget(const clap_host_t *host, clap_id id, clap_param_clear_flags flags) { (void)host, (void)id, (void)flags; }
static bool CLAP_ABI resize(const clap_host_t *host, uint32_t width, uint32_t height) {
    return (void)host, asked[0] = (int)width, asked[1] = (int)height, true;
}
static bool CLAP_ABI refuse(const clap_host_t *host) { return (void)host, false; }

static const void *CLAP_ABI extension(const clap_host_t *host, const char *id) {
    static const clap_host_timer_support_t timer = {start, stop};
    static const clap_host_gui_t gui = {nothing, resize, refuse, refuse, closed};
    static const clap_host_params_t params = {rescan, forget, nothing};
    (void)host;
    return !strcmp(id, CLAP_EXT_TIMER_SUPPORT) ? (const void *)&timer
           : !strcmp(id, CLAP_EXT_GUI)         ? (const void *)&gui
           : !strcmp(id, CLAP_EXT_PARAMS)      ? (const void *)&params : NULL;
}

static uint32_t CLAP_ABI count(const clap_input_events_t *list) { return *(const uint32_t *)list->ctx; }
static const clap_event_header_t *CLAP_ABI get(const clap_input_events_t *list, uint32_t i) {
    static const clap_event_note_t note = {{sizeof note, 0, CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_NOTE_ON, 0}, 1, 0, 0, 69, 0.8};
    return (void)list, (void)i, &note.header;
}
static bool CLAP_ABI push(const clap_output_events_t *list, const clap_event_header_t *event) {
    if (event->type == CLAP_EVENT_PARAM_VALUE) edits++;
    if (event->type == CLAP_EVENT_PARAM_GESTURE_BEGIN) gestures[0]++;
    if (event->type == CLAP_EVENT_PARAM_GESTURE_END) gestures[1]++;
    return (void)list, true;
}

static void play(int blocks) {
    static uint32_t notes = 1;
    float left[256], right[256], *both[] = {left, right};
    clap_audio_buffer_t out = {both, NULL, 2, 0, 0};
    const clap_input_events_t in = {&notes, count, get};
    const clap_output_events_t outs = {NULL, push};
    const clap_process_t block = {0, 256, NULL, NULL, &out, 0, 1, &in, &outs};
    for (; blocks > 0; blocks--, notes = 0) plugin->process(plugin, &block);
}

static void *play_on(void *blocks) { return play(*(int *)blocks), NULL; }

static struct { char text[1 << 16]; uint64_t size, at; } kept;
static int64_t CLAP_ABI put(const clap_ostream_t *stream, const void *bytes, uint64_t n) {
    if (kept.size + n > sizeof kept.text) return -1;
    memcpy(kept.text + kept.size, bytes, n);
    return (void)stream, kept.size += n, (int64_t)n;
}
static int64_t CLAP_ABI take(const clap_istream_t *stream, void *bytes, uint64_t n) {
    n = n < kept.size - kept.at ? n : kept.size - kept.at;
    memcpy(bytes, kept.text + kept.at, n);
    return (void)stream, kept.at += n, (int64_t)n;
}

static void send(int kind, int detail, int px, int py) {
    xcb_query_tree_reply_t *tree = xcb_query_tree_reply(x, xcb_query_tree(x, window), NULL);
    const xcb_window_t inner = xcb_query_tree_children(tree)[0];
    xcb_button_press_event_t event = {.response_type = (uint8_t)kind, .detail = (uint8_t)detail, .event = inner,
                                      .event_x = (int16_t)px, .event_y = (int16_t)py, .same_screen = 1};
    xcb_send_event(x, 0, inner, XCB_EVENT_MASK_NO_EVENT, (const char *)&event); /* to who made it */
    free(xcb_get_input_focus_reply(x, xcb_get_input_focus(x), NULL));           /* it has been sent */
    free(tree);
}

static void shot(const char *path, int width, int height) {
    xcb_get_image_reply_t *image = xcb_get_image_reply(
        x, xcb_get_image(x, XCB_IMAGE_FORMAT_Z_PIXMAP, window, 0, 0, (uint16_t)width, (uint16_t)height, ~0u), NULL);
    const uint8_t *pixel = image ? xcb_get_image_data(image) : NULL;
    FILE *file = fopen(path, "wb");
    fprintf(file, "P6 %d %d 255\n", width, height);
    for (int i = 0; pixel && i < width * height; i++, pixel += 4) fputc(pixel[2], file), fputc(pixel[1], file), fputc(pixel[0], file);
    fclose(file);
    free(image);
}

int main(int words, char **word) {
    char line[512], text[256];
    pthread_t thread;
    int blocks = 0;
    void *library = words == 2 ? dlopen(word[1], RTLD_NOW | RTLD_LOCAL) : NULL;
    const clap_plugin_entry_t *entry = library ? dlsym(library, "clap_entry") : NULL;
    if (!entry || !entry->init(word[1])) return 3;
    const clap_plugin_factory_t *factory = entry->get_factory(CLAP_PLUGIN_FACTORY_ID);
    const clap_host_t host = {CLAP_VERSION, NULL, "host", "", "", "1", extension, nothing, nothing, nothing};
    plugin = factory->create_plugin(factory, &host, factory->get_plugin_descriptor(factory, 0)->id);
    if (!plugin || !plugin->init(plugin) || !plugin->activate(plugin, 48000.0, 1, 256)) return 4;
    const clap_plugin_gui_t *gui = plugin->get_extension(plugin, CLAP_EXT_GUI);
    const clap_plugin_params_t *params = plugin->get_extension(plugin, CLAP_EXT_PARAMS);
    const clap_plugin_timer_support_t *timer = plugin->get_extension(plugin, CLAP_EXT_TIMER_SUPPORT);
    const clap_plugin_state_t *state = plugin->get_extension(plugin, CLAP_EXT_STATE);
    x = xcb_connect(NULL, NULL);
    if (!gui || xcb_connection_has_error(x)) return 5;
    const xcb_screen_t *screen = xcb_setup_roots_iterator(xcb_get_setup(x)).data;
    uint32_t width = 0, height = 0;
    while (fgets(line, sizeof line, stdin)) {
        unsigned a = 0, b = 0;
        double value = 0.0;
        if (sscanf(line, "%*s %255s", text) == 1) sscanf(text, "%u", &a), sscanf(line, "%*s %*s %u", &b);
        edits = asked[0] = asked[1] = 0;
        if (!strncmp(line, "open", 4)) {
            if (!gui->create(plugin, CLAP_WINDOW_API_X11, false) || !gui->get_size(plugin, &width, &height)) return 6;
            window = xcb_generate_id(x);
            xcb_create_window(x, XCB_COPY_FROM_PARENT, window, screen->root, 0, 0, (uint16_t)width, (uint16_t)height, 0,
                              XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual, 0, NULL);
            xcb_map_window(x, window);
            free(xcb_get_input_focus_reply(x, xcb_get_input_focus(x), NULL));
            const clap_window_t parent = {CLAP_WINDOW_API_X11, {.x11 = window}};
            if (!gui->set_parent(plugin, &parent) || !gui->show(plugin)) return 7;
        } else if (!strncmp(line, "close", 5)) {
            xcb_destroy_window(x, window); /* before the plug-in closes its own, as some hosts do */
            free(xcb_get_input_focus_reply(x, xcb_get_input_focus(x), NULL));
            gui->destroy(plugin);
        } else if (!strncmp(line, "play", 4)) play((int)a);
        else if (!strncmp(line, "begin", 5)) blocks = (int)a, pthread_create(&thread, NULL, play_on, &blocks);
        else if (!strncmp(line, "end", 3)) pthread_join(thread, NULL);
        else if (!strncmp(line, "state", 5)) {
            const clap_ostream_t out = {NULL, put};
            const clap_istream_t in = {NULL, take};
            kept.size = kept.at = 0;
            if (!state->save(plugin, &out) || !state->load(plugin, &in)) return 8;
        } else if (!strncmp(line, "tick", 4)) timer->on_timer(plugin, 7);
        else if (!strncmp(line, "click", 5)) send(XCB_BUTTON_PRESS, 1, (int)a, (int)b);
        else if (!strncmp(line, "drag", 4)) send(XCB_MOTION_NOTIFY, 0, (int)a, (int)b);
        else if (!strncmp(line, "release", 7)) send(XCB_BUTTON_RELEASE, 1, 0, 0);
        else if (!strncmp(line, "key", 3)) send(XCB_KEY_PRESS, (int)a, 0, 0);
        else if (!strncmp(line, "size", 4)) {
            width = a, height = b;
            gui->adjust_size(plugin, &width, &height);
            gui->set_size(plugin, width, height);
            const uint32_t values[] = {width, height};
            xcb_configure_window(x, window, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, values);
            free(xcb_get_input_focus_reply(x, xcb_get_input_focus(x), NULL));
        } else if (!strncmp(line, "shot", 4)) shot(text, (int)width, (int)height);
        else if (!strncmp(line, "value", 5)) params->get_value(plugin, a, &value);
        printf("%g %d %d %d %d %u %u %d %d\n", value, timers, edits, asked[0], asked[1], width, height, gestures[0], gestures[1]);
        fflush(stdout);
    }
    plugin->deactivate(plugin), plugin->destroy(plugin), entry->deinit();
    xcb_disconnect(x);
    return 0;
}
