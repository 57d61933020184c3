/* The plug-in's own window: strings, bow and fingers as they move, what is heard, and parameters to
 * choose, to slide and to type. It takes snapshots of the instrument (`yehu_snapshot`) on the host's main thread, and
 * is nothing while it is closed: no memory, window or timer.
 */
#ifndef YEHU_EDITOR_HPP
#define YEHU_EDITOR_HPP

#include "canvas.hpp"
#include "instrument.hpp"
#include "window.hpp"

namespace yehu {

/* What a format does for its editor. */
struct EditorHost {
    void *owner;
    void (*edit)(void *owner, int parameter, double value);
    void (*hold)(void *owner, int parameter, bool is_held); /* edits between the two are of one gesture */
    bool (*resize)(void *owner, int width, int height); /* ask for it; the host may set the size */
};

class Editor {
public:
    static constexpr int WIDTH = 680, HEIGHT = 358, INTERVAL_MS = 33;
    static constexpr const char *NAME = "Yehu";

    Editor(const Instrument &instrument, const EditorHost &host) : instrument(instrument), host(host) {}
    bool open(uintptr_t parent);
    void close() { release(), window.close(); }
    void show(bool is_shown) { window.show(is_shown); }
    uintptr_t handle() const { return window.handle(); }
    int file() const { return window.file(); }
    int width() const { return wide; }
    int height() const { return high; }
    /* The largest picture that fits into a size, which becomes its size. */
    static void fit(int *width, int *height);
    void set_size(int width, int height);

    /* From the window, and `tick` from a timer. */
    void tick();
    void press(int x, int y);
    void drag(int x, int y);
    void release();
    void turn(int x, int y, int steps);
    void key(Key key);
    void type(char letter);

private:
    static constexpr int CHOOSERS = 5, SLIDERS = 12, CONTROLS = CHOOSERS + SLIDERS, LONGEST = 12, SHAPES = 8, POINTS = 64, STRINGS = 2;

    bool follow();
    void put();
    void draw();
    void draw_instrument();
    void draw_string(int string);
    void draw_gauges();
    void draw_gauge(int row, const char *name, const char *value, float share, float from, float to);
    void draw_chooser(int chooser);
    void draw_slider(int slider);
    int chooser_at(float x, float y) const;
    int slider_at(float x, float y) const;
    void slide(int slider, double unit);
    void set(int slider, double value);
    void choose(int chooser, int choice);
    int choice_of(int chooser) const;
    void write(int parameter, char *into, size_t size) const;
    void focus_on(int control);
    void begin_typing();
    void end_typing(bool counts);
    void name();
    void zoom(int percent);

    const Instrument &instrument;
    const EditorHost host;
    Window window;
    Canvas canvas;
    int wide = WIDTH, high = HEIGHT;
    bool is_stale = true, is_at_rest = false;
    int held = -1, pressed = -1, pressed_at = 0, ticks = 0; /* of sliders: which the mouse moves; pressed last, and when */
    char typed[LONGEST] = ""; /* a value for the slider in focus, */
    int length = -1;          /* of so many letters; -1: none is typed */
    double slid[SLIDERS] = {};
    int focus = 0, chosen[CHOOSERS] = {-1, -1, -1, -1, -1};
    struct yehu_snapshot seen = {};
    float shapes[STRINGS][SHAPES][POINTS] = {}; /* m; the latest at `latest` */
    int latest = 0;
    float swing = 0.0f; /* m, the greatest of late */
    int sounding = -1, looks = 0; /* key, and how many of late are in: */
    double bent = 0.0;            /* cents, the mean, which follows no vibrato */
};

} /* namespace yehu */

#endif
