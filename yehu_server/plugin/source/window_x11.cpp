/* The window on Linux, by XCB: its errors are events, where Xlib ends the host's process. The library
 * is searched for when a window is opened, so that the plug-in loads where there is none.
 */
#include "window.hpp"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <xcb/xcb.h>

#include "editor.hpp"

namespace yehu {

namespace {
constexpr uint32_t EMBEDDED[] = {0, 1}; /* version of XEmbed; that it is to be seen */
constexpr int MAX_BYTES = 1 << 17;     /* of a picture in one request */
constexpr int LEFT_BUTTON = 1, WHEEL_UP = 4, WHEEL_DOWN = 5;

#define YEHU_XCB(each)                                                                             \
    each(connect) each(disconnect) each(connection_has_error) each(get_setup) each(flush)          \
    each(setup_roots_iterator) each(generate_id) each(create_window) each(destroy_window)          \
    each(map_window) each(unmap_window) each(configure_window) each(create_gc) each(put_image)     \
    each(create_pixmap) each(free_pixmap) each(change_window_attributes) each(clear_area)          \
    each(poll_for_event) each(set_input_focus) each(get_keyboard_mapping)                          \
    each(get_keyboard_mapping_reply) each(get_keyboard_mapping_keysyms)                            \
    each(get_keyboard_mapping_keysyms_length) each(intern_atom) each(intern_atom_reply)            \
    each(change_property) each(get_file_descriptor)

struct Xcb {
#define MEMBER(name) decltype(&xcb_##name) name;
    YEHU_XCB(MEMBER)
#undef MEMBER
};

const Xcb *library() {
    static Xcb made = {};
    static void *loaded = nullptr;
    if (loaded) return &made;
    loaded = dlopen("libxcb.so.1", RTLD_NOW | RTLD_LOCAL);
    bool has_all = loaded != nullptr;
#define FIND(name) has_all = has_all && (made.name = (decltype(made.name))dlsym(loaded, "xcb_" #name));
    YEHU_XCB(FIND)
#undef FIND
    return has_all ? &made : nullptr;
}

/* What the keys of a keyboard mean, by X's numbers; those of letters and of the keypad are ASCII's. */
constexpr uint32_t KEYPAD = 0xFF80, KEYPAD_FIRST = 0xFFAA, KEYPAD_LAST = 0xFFB9;

bool is_of_keypad(uint32_t symbol) { return symbol >= KEYPAD_FIRST && symbol <= KEYPAD_LAST; }

void press_key(Editor &editor, uint32_t symbol) {
    const struct { uint32_t symbol; Key key; } known[] = {
        {0xFF51, Key::LEFT},  {0xFF52, Key::UP},       {0xFF53, Key::RIGHT}, {0xFF54, Key::DOWN},
        {0xFF50, Key::FIRST}, {0xFF57, Key::LAST},     {0xFF09, Key::NEXT},  {0xFE20, Key::PREVIOUS},
        {0xFF0D, Key::ENTER}, {0xFF8D, Key::ENTER},    {0xFF1B, Key::ESCAPE}, {0xFF08, Key::BACK},
    };
    for (const auto &each : known)
        if (each.symbol == symbol) return editor.key(each.key);
    if (is_of_keypad(symbol)) symbol -= KEYPAD;
    if (symbol < 128) editor.type((char)symbol);
}
} /* namespace */

struct Window::Native {
    const Xcb *x;
    Editor *editor;
    xcb_connection_t *connection;
    xcb_window_t window;
    xcb_gcontext_t pen;
    xcb_pixmap_t picture; /* what X shows by itself, as the window's background */
    uint8_t depth;
    xcb_get_keyboard_mapping_reply_t *keys; /* from the code `first` on */
    xcb_keycode_t first;

    void make_picture(int width, int height);
};

void Window::Native::make_picture(int width, int height) {
    if (picture) x->free_pixmap(connection, picture);
    picture = x->generate_id(connection);
    x->create_pixmap(connection, depth, picture, window, (uint16_t)width, (uint16_t)height);
    x->change_window_attributes(connection, window, XCB_CW_BACK_PIXMAP, &picture);
}

bool Window::has_timer() { return false; }

int Window::file() const { return native ? native->x->get_file_descriptor(native->connection) : -1; }

bool Window::open(Editor &editor, uintptr_t parent, int width, int height) {
    const Xcb *x = library();
    if (native || !x) return false;
    xcb_connection_t *c = x->connect(nullptr, nullptr);
    Native *made = x->connection_has_error(c) ? nullptr : (Native *)calloc(1, sizeof *made);
    if (!made) return x->disconnect(c), false;
    const xcb_setup_t *setup = x->get_setup(c);
    const xcb_screen_t *screen = x->setup_roots_iterator(setup).data;
    *made = {x, &editor, c, x->generate_id(c), x->generate_id(c), 0, screen->root_depth, nullptr,
             setup->min_keycode};
    const uint32_t wanted = XCB_EVENT_MASK_BUTTON_PRESS | XCB_EVENT_MASK_BUTTON_RELEASE | XCB_EVENT_MASK_BUTTON_1_MOTION | XCB_EVENT_MASK_KEY_PRESS;
    const uint32_t values[] = {0, wanted, screen->default_colormap};
    x->create_window(c, screen->root_depth, made->window, (xcb_window_t)parent, 0, 0, (uint16_t)width, (uint16_t)height,
                     0, XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual,
                     XCB_CW_BORDER_PIXEL | XCB_CW_EVENT_MASK | XCB_CW_COLORMAP, values);
    x->create_gc(c, made->pen, made->window, 0, nullptr);
    made->make_picture(width, height);
    const char name[] = "_XEMBED_INFO";
    const auto asked = x->intern_atom(c, 0, sizeof name - 1, name);
    const auto keys = x->get_keyboard_mapping(c, made->first, (uint8_t)(setup->max_keycode - made->first + 1));
    if (auto *atom = x->intern_atom_reply(c, asked, nullptr)) {
        x->change_property(c, XCB_PROP_MODE_REPLACE, made->window, atom->atom, atom->atom, 32, 2, EMBEDDED);
        free(atom);
    }
    made->keys = x->get_keyboard_mapping_reply(c, keys, nullptr);
    native = made;
    show(true);
    return true;
}

void Window::close() {
    if (!native) return;
    native->x->destroy_window(native->connection, native->window);
    native->x->disconnect(native->connection);
    free(native->keys);
    free(native);
    native = nullptr;
}

uintptr_t Window::handle() const { return native ? native->window : 0; }

void Window::resize(int width, int height) {
    const uint32_t values[] = {(uint32_t)width, (uint32_t)height};
    native->x->configure_window(native->connection, native->window, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, values);
    native->make_picture(width, height);
    native->x->flush(native->connection);
}

void Window::show(bool is_shown) {
    if (!native) return;
    if (is_shown) native->x->map_window(native->connection, native->window);
    else native->x->unmap_window(native->connection, native->window);
    native->x->flush(native->connection);
}

void Window::put(const uint32_t *pixels, int width, int height) {
    const int rows = MAX_BYTES / (4 * width);
    for (int y = 0; y < height; y += rows) {
        const int now = height - y < rows ? height - y : rows;
        native->x->put_image(native->connection, XCB_IMAGE_FORMAT_Z_PIXMAP, native->picture, native->pen, (uint16_t)width,
                             (uint16_t)now, 0, (int16_t)y, 0, native->depth, (uint32_t)(4 * width * now),
                             (const uint8_t *)(pixels + y * width));
    }
    native->x->clear_area(native->connection, 0, native->window, 0, 0, 0, 0); /* all of it */
    native->x->flush(native->connection);
}

void Window::name(const char *) {}

void Window::poll() {
    while (native) {
        xcb_generic_event_t *event = native->x->poll_for_event(native->connection);
        if (!event) return;
        const int kind = event->response_type & 127;
        const auto *press = (const xcb_button_press_event_t *)event;
        if (kind == XCB_BUTTON_PRESS && press->detail == LEFT_BUTTON) {
            native->x->set_input_focus(native->connection, XCB_INPUT_FOCUS_PARENT, native->window, press->time);
            native->editor->press(press->event_x, press->event_y);
        }
        if (kind == XCB_BUTTON_RELEASE && press->detail == LEFT_BUTTON) native->editor->release();
        if (kind == XCB_MOTION_NOTIFY) native->editor->drag(press->event_x, press->event_y);
        if (kind == XCB_BUTTON_PRESS && (press->detail == WHEEL_UP || press->detail == WHEEL_DOWN))
            native->editor->turn(press->event_x, press->event_y, press->detail == WHEEL_UP ? -1 : 1);
        if (kind == XCB_KEY_PRESS && native->keys) {
            const int each = native->keys->keysyms_per_keycode, at = each * (press->detail - native->first);
            const xcb_keysym_t *symbols = native->x->get_keyboard_mapping_keysyms(native->keys);
            if (at >= 0 && at + 1 < native->x->get_keyboard_mapping_keysyms_length(native->keys)) {
                const bool is_second = each > 1 && (press->state & XCB_MOD_MASK_SHIFT || is_of_keypad(symbols[at + 1]));
                press_key(*native->editor, symbols[at + (is_second && symbols[at + 1])]);
            }
        }
        free(event);
    }
}

} /* namespace yehu */
