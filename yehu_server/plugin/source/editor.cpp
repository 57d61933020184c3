#include "editor.hpp"

#include <math.h>
#include <stdio.h>
#include <string.h>

namespace yehu {

namespace {
enum : uint32_t {
    PAPER = 0xF7F3EA, SURFACE = 0xFFFDF8, INK = 0x26211C, SOFT = 0x685F55, LINE = 0xDDD3C3,
    INNER = 0xA3560C, OUTER = 0x0C6A75, GOOD = 0x23703F, BAD = 0xAD3019, WOOD = 0xE2BF8D,
    EDGE = 0xB58754, SHELL = 0x5F3A22, LID = 0xF0DCB2, HAIR = 0xD9C9A0,
};
constexpr uint32_t STRING_COLOURS[] = {INNER, OUTER};

/* Places in the picture. */
constexpr float LOOP_X = 34, BRIDGE_X = 420, LANES[] = {84, 116}, MIDDLE = 100;
constexpr float PANEL_X = 512, PANEL_WIDTH = 156;
constexpr float GAUGES_Y = 112, GAUGE_HEIGHT = 33;
constexpr float CHOOSERS_X[] = {12, 140, 252, 384, 536, 672}, CHOOSER_GAP = 4, CHOOSERS_Y = 304, CHOOSER_HEIGHT = 40;
constexpr float ARROW = 20, ZOOM_X = 628, ZOOM_Y = 20;

constexpr float SLIDERS_X = 24, SLIDER_STEP = 119, SLIDER_WIDTH = 105, SLIDERS_Y = 187, SLIDER_HEIGHT = 28, WORDS_HEIGHT = 14;
constexpr int IN_A_ROW = 4, DOUBLE_TICKS = 12;
constexpr double WHEEL_STEP = 0.02;

constexpr int SLID[] = {VIBRATO,      VIBRATO_RATE, VIBRATO_DELAY, GAIN,          DYNAMICS, PRESSURE_OF_BOW,
                        BOW_POSITION, BRILLIANCE,   ROOM_LEVEL,    ROOM_DISTANCE, ROOM_PAN, SWAY};
constexpr int CHOSEN[] = {PRESET, ROOM, ARTICULATION, MAPPING, TUNING};
constexpr double MIN_SWING = 0.15e-3, KEPT = 0.995; /* m, and of the swing from one snapshot to the next */
constexpr float SWING = 26, HAIR_LENGTH = 66;
constexpr double SILENT = 1e-4, CERTAIN = 0.8, TWICE = 1.5; /* as the page has them */
constexpr int MEAN_OF = 18; /* looks: some turns of a vibrato */
constexpr int PERCENTS[] = {75, 100, 125, 150, 200, 250, 300};

/* The string's motion, from what the ear hears, and its colour. */
const char *regime_of(const struct yehu_snapshot &seen, double most, uint32_t *colour) {
    *colour = SOFT;
    if (seen.string < 0 || seen.speed == 0.0) return seen.rms > SILENT ? "rings by itself" : "at rest";
    if (seen.certainty == 0.0) return "not heard yet";
    const bool slips = seen.slips >= TWICE;
    *colour = seen.certainty >= CERTAIN && !slips ? GOOD : BAD;
    if (seen.certainty >= CERTAIN) return slips ? "slips too often" : "Helmholtz motion";
    return seen.force > most ? "raucous" : slips ? "slips too often" : "not settled";
}

float chooser_width(int chooser) { return CHOOSERS_X[chooser + 1] - CHOOSERS_X[chooser] - CHOOSER_GAP; }
float share_of(double value, double lo, double hi) { return (float)fmin(fmax((value - lo) / (hi - lo), 0.0), 1.0); }
float force_share(double force) { return share_of(log10(fmax(force, 1e-9)), -2.0, 1.0); }
} /* namespace */

bool Editor::open(uintptr_t parent) {
    if (!canvas.resize(wide, high, (float)wide / WIDTH) || !window.open(*this, parent, wide, high)) return false;
    is_stale = true;
    tick(); /* hosts may be late with their first */
    return true;
}

void Editor::fit(int *width, int *height) {
    const int least = WIDTH / 2, most = 4 * WIDTH;
    const int by_height = ((*height + 1) * WIDTH - 1) / HEIGHT;
    int fitting = by_height < *width ? by_height : *width;
    fitting = fitting < least ? least : fitting > most ? most : fitting;
    *width = fitting, *height = fitting * HEIGHT / WIDTH;
}

void Editor::set_size(int width, int height) {
    fit(&width, &height);
    if (width == wide && height == high) return;
    wide = width, high = height;
    if (!window.is_open()) return;
    window.resize(wide, high);
    canvas.resize(wide, high, (float)wide / WIDTH);
    put();
}

/* -- what the user does ----------------------------------------------------------------------- */

int Editor::chooser_at(float x, float y) const {
    if (y < CHOOSERS_Y || y >= CHOOSERS_Y + CHOOSER_HEIGHT) return -1;
    for (int i = 0; i < CHOOSERS; i++)
        if (x >= CHOOSERS_X[i] && x < CHOOSERS_X[i + 1] - CHOOSER_GAP) return i;
    return -1;
}

void Editor::choose(int chooser, int choice) {
    const int most = parameters[CHOSEN[chooser]].steps;
    choice = choice < 0 ? 0 : choice > most ? most : choice;
    focus_on(chooser);
    if (choice != (int)instrument.value(CHOSEN[chooser])) host.edit(host.owner, CHOSEN[chooser], choice);
}

/* From which the arrows step: of presets the one that was chosen, also where it was changed. */
int Editor::choice_of(int chooser) const {
    const int parameter = CHOSEN[chooser];
    return parameter < SETS ? instrument.all().chosen(parameter) : (int)instrument.value(parameter);
}

void Editor::write(int parameter, char *into, size_t size) const {
    instrument.all().write(parameter, instrument.value(parameter), into, size);
}

int Editor::slider_at(float x, float y) const {
    const float column = (x - SLIDERS_X) / SLIDER_STEP, row = (y - SLIDERS_Y) / SLIDER_HEIGHT;
    const bool is_inside = column >= 0 && column < IN_A_ROW && row >= 0 && row < SLIDERS / IN_A_ROW;
    return is_inside ? (int)column + IN_A_ROW * (int)row : -1;
}

void Editor::slide(int slider, double unit) { set(slider, from_unit(SLID[slider], unit)); }

void Editor::set(int slider, double value) {
    focus_on(CHOOSERS + slider);
    if (value != instrument.value(SLID[slider])) host.edit(host.owner, SLID[slider], value);
}

void Editor::release() {
    if (held >= 0) host.hold(host.owner, SLID[held], false);
    held = -1;
}

/* To where the mouse is. */
void Editor::drag(int px, int) {
    if (held < 0) return;
    const float x = (float)px * WIDTH / (float)wide - SLIDERS_X - SLIDER_STEP * (float)(held % IN_A_ROW);
    slide(held, x / SLIDER_WIDTH);
}

void Editor::press(int px, int py) {
    const float scale = (float)wide / WIDTH, x = (float)px / scale, y = (float)py / scale;
    const int chooser = chooser_at(x, y), slider = slider_at(x, y);
    const bool is_double = slider >= 0 && slider == pressed && ticks - pressed_at < DOUBLE_TICKS;
    end_typing(!is_double);
    release(); /* which may not have been heard of */
    pressed = is_double ? -1 : slider, pressed_at = ticks;
    if (is_double) set(slider, instrument.all().usual(SLID[slider]));
    else if (slider >= 0 && fmodf(y - SLIDERS_Y, SLIDER_HEIGHT) < WORDS_HEIGHT) focus_on(CHOOSERS + slider), begin_typing();
    else if (slider >= 0) held = slider, host.hold(host.owner, SLID[slider], true), drag(px, py);
    else if (chooser >= 0) {
        const float from = x - CHOOSERS_X[chooser], width = chooser_width(chooser);
        const bool is_name = from > ARROW && from < width - ARROW;
        const bool restores = is_name && CHOSEN[chooser] < SETS && instrument.all().is_changed(CHOSEN[chooser]);
        turn(px, py, restores ? 0 : from < width / 2 ? -1 : 1);
    } else if (y < 2 * ZOOM_Y && x > ZOOM_X - 12) zoom(wide >= 2 * WIDTH ? -1000 : 1);
}

void Editor::turn(int px, int py, int steps) {
    const float scale = (float)wide / WIDTH;
    const int chooser = chooser_at((float)px / scale, (float)py / scale);
    const int slider = slider_at((float)px / scale, (float)py / scale);
    if (slider >= 0) slide(slider, to_unit(SLID[slider], instrument.value(SLID[slider])) - WHEEL_STEP * steps);
    if (chooser >= 0) choose(chooser, choice_of(chooser) + steps);
}

void Editor::key(Key key) {
    const bool was_typing = length >= 0;
    if (key == Key::BACK) {
        if (length > 0) typed[--length] = 0, is_stale = true;
        return;
    }
    end_typing(key != Key::ESCAPE);
    if (key == Key::ENTER && !was_typing) begin_typing();
    if (key == Key::ENTER || key == Key::ESCAPE) return;
    if (key == Key::NEXT) return focus_on((focus + 1) % CONTROLS);
    if (key == Key::PREVIOUS) return focus_on((focus + CONTROLS - 1) % CONTROLS);
    if (focus >= CHOOSERS) {
        const int slider = focus - CHOOSERS;
        const double unit = to_unit(SLID[slider], instrument.value(SLID[slider]));
        const bool is_less = key == Key::LEFT || key == Key::DOWN;
        return slide(slider, key == Key::FIRST ? 0.0 : key == Key::LAST ? 1.0 : unit + (is_less ? -WHEEL_STEP : WHEEL_STEP));
    }
    const int now = choice_of(focus);
    switch (key) {
    case Key::LEFT: case Key::UP: return choose(focus, now - 1);
    case Key::RIGHT: case Key::DOWN: return choose(focus, now + 1);
    case Key::FIRST: return choose(focus, 0);
    case Key::LAST: return choose(focus, parameters[CHOSEN[focus]].steps);
    default: return;
    }
}

/* A number for a slider; for a chooser, the next name that begins so. */
void Editor::type(char letter) {
    const bool is_slider = focus >= CHOOSERS, is_digit = letter >= '0' && letter <= '9';
    if (letter == ',') letter = '.';
    const bool is_minus = letter == '-' && (length >= 0 || (is_slider && parameters[SLID[focus - CHOOSERS]].lo < 0));
    if (is_slider && (is_digit || letter == '.' || is_minus)) {
        if (length < 0) begin_typing();
        if (length + 1 < LONGEST) typed[length++] = letter, typed[length] = 0, is_stale = true;
    } else if (letter == '+' || letter == '=' || letter == '-') zoom(letter == '-' ? -1 : 1);
    else if (!is_slider) {
        const Parameter &p = parameters[CHOSEN[focus]];
        const int now = choice_of(focus), count = p.steps + 1;
        for (int i = 1; i < count; i++)
            if (*p.choices[(now + i) % count] == letter) return choose(focus, (now + i) % count);
    }
}

void Editor::begin_typing() {
    if (focus >= CHOOSERS) *typed = 0, length = 0, is_stale = true;
}

void Editor::end_typing(bool counts) {
    double value;
    counts = counts && length > 0 && Settings::read(SLID[focus - CHOOSERS], typed, &value);
    is_stale |= length >= 0;
    length = -1;
    if (counts) set(focus - CHOOSERS, value);
}

void Editor::focus_on(int control) { focus = control, is_stale = true; }

/* What has the focus, and its value, for screen readers. */
void Editor::name() {
    const int parameter = focus < CHOOSERS ? CHOSEN[focus] : SLID[focus - CHOOSERS];
    char text[160], value[64];
    write(parameter, value, sizeof value);
    snprintf(text, sizeof text, "%s: %s", parameters[parameter].name, length >= 0 ? typed : value);
    window.name(text);
}

/* To the next larger or smaller size; far down is the size at first. */
void Editor::zoom(int steps) {
    const int count = sizeof PERCENTS / sizeof *PERCENTS;
    int at = 0;
    while (at + 1 < count && PERCENTS[at + 1] * WIDTH <= 100 * wide) at++;
    at = steps < -count ? 1 : at + steps;
    if (at < 0 || at >= count) return;
    int width = PERCENTS[at] * WIDTH / 100, height = PERCENTS[at] * HEIGHT / 100;
    fit(&width, &height);
    if (host.resize(host.owner, width, height)) set_size(width, height);
}

/* -- what is drawn ---------------------------------------------------------------------------- */

void Editor::tick() {
    ticks++;
    window.poll();
    if (window.is_open() && (follow() || is_stale)) put();
}

void Editor::put() {
    if (canvas.width() == 0) return; /* there was no memory */
    draw();
    window.put(canvas.pixels(), canvas.width(), canvas.height());
    if (is_stale) name();
    is_stale = false;
}

/* Take a snapshot; whether what is shown has changed. */
bool Editor::follow() {
    bool has_changed = false;
    for (int i = 0; i < CHOOSERS; i++) {
        const int now = (int)instrument.value(CHOSEN[i]);
        has_changed |= now != chosen[i];
        chosen[i] = now;
    }
    for (int i = 0; i < SLIDERS; i++) {
        has_changed |= instrument.value(SLID[i]) != slid[i];
        slid[i] = instrument.value(SLID[i]);
    }
    const double before = seen.frame;
    if (!instrument.snapshot(&seen) || seen.frame == before) return has_changed;
    const bool rests = seen.string < 0 && !(seen.rms > SILENT);
    if (rests && is_at_rest) return has_changed;
    is_at_rest = rests;
    latest = (latest + 1) % SHAPES;
    swing = (float)fmax(MIN_SWING, KEPT * swing);
    for (int string = 0; string < STRINGS; string++)
        for (int i = 0; i < POINTS; i++) shapes[string][latest][i] = (float)seen.shapes[string][i];
    const int key = seen.pitch == seen.pitch ? (int)floor(seen.pitch + 0.5) : -1;
    const double now = 100.0 * (seen.pitch - key) + (seen.certainty >= CERTAIN ? seen.error : 0.0);
    if (key != sounding) sounding = key, looks = 0;
    if (looks < MEAN_OF) looks++;
    bent = looks > 1 ? bent + (now - bent) / looks : now;
    return true;
}

void Editor::draw() {
    canvas.fill(PAPER);
    canvas.box(12, 10, PANEL_X - 17, CHOOSERS_Y - 42, 8, SURFACE);
    draw_instrument();
    draw_gauges();
    for (int i = 0; i < SLIDERS; i++) draw_slider(i);
    for (int i = 0; i < CHOOSERS; i++) draw_chooser(i);
}

void Editor::draw_instrument() {
    const float ring[] = {BRIDGE_X + 22, MIDDLE};
    canvas.box(16, LANES[0] - 14, BRIDGE_X - 40, LANES[1] - LANES[0] + 28, 14, EDGE);
    canvas.box(17, LANES[0] - 13, BRIDGE_X - 42, LANES[1] - LANES[0] + 26, 13, WOOD);
    canvas.disc(ring[0], ring[1], 62, SHELL);
    canvas.disc(ring[0], ring[1], 55, LID);
    canvas.box(LOOP_X - 2, LANES[0] - 14, 4, LANES[1] - LANES[0] + 28, 2, SHELL);
    canvas.box(BRIDGE_X - 2, LANES[0] - 12, 4, LANES[1] - LANES[0] + 24, 2, SHELL);
    const float along = seen.length > 0 ? (BRIDGE_X - LOOP_X) / (float)seen.length : 0;
    const int string = seen.string > 0 ? 1 : 0;
    if (seen.string >= 0) {
        const float x = LOOP_X + along * (float)seen.bow_x, share = seen.hair_length > 0 ? share_of(seen.hair_place, 0, seen.hair_length) : 0.5f;
        const float frog = LANES[string] + share * HAIR_LENGTH, tip = frog - HAIR_LENGTH;
        const float stick[] = {x, tip, x - 7, tip + 8, x - 7, frog}, hair[] = {x, tip, x, frog};
        canvas.line(stick, 3, 3, EDGE);
        canvas.line(hair, 2, 2 + 5 * share_of(seen.force, 0, 3), HAIR);
        canvas.box(x - 9, frog - 6, 13, 12, 3, SHELL);
    }
    for (int i = 0; i < STRINGS; i++) draw_string(i);
    for (const double &press : seen.finger_press) {
        if (!(press > 0)) continue;
        const float x = LOOP_X + along * (float)seen.finger_x[&press - seen.finger_press];
        canvas.disc(x, LANES[string], 7 + 3 * share_of(press, 0, 3), STRING_COLOURS[string]);
        canvas.disc(x, LANES[string], 3, SURFACE);
    }
    if (seen.string >= 0) canvas.disc(LOOP_X + along * (float)seen.bow_x, LANES[string], 4, STRING_COLOURS[string]);
}

/* Its motion about the middle of the latest snapshots, which are seen behind the last one. */
void Editor::draw_string(int string) {
    float points[2 * POINTS], middle[POINTS] = {};
    const bool moves = seen.rms > SILENT && (seen.string < 0 || seen.string == string);
    for (int i = 0; moves && i < POINTS; i++) {
        for (const auto &shape : shapes[string]) middle[i] += shape[i] / SHAPES;
        swing = fmaxf(swing, fabsf(shapes[string][latest][i] - middle[i]));
    }
    for (int age = moves ? SHAPES - 1 : 0; age >= 0; age--) {
        const float *shape = shapes[string][(latest + SHAPES - age) % SHAPES];
        for (int i = 0; i < POINTS; i++) {
            points[2 * i] = LOOP_X + (BRIDGE_X - LOOP_X) * (float)i / (POINTS - 1);
            points[2 * i + 1] = LANES[string] + (moves ? SWING * (shape[i] - middle[i]) / swing : 0.0f);
        }
        canvas.line(points, POINTS, age ? 1.0f : 1.8f, STRING_COLOURS[string], age ? 0.25f : 1.0f);
    }
}

void Editor::draw_gauges() {
    static const char *const names[] = {"C", "C#", "D", "Eb", "E", "F", "F#", "G", "G#", "A", "Bb", "B"};
    const double speed = fabs(seen.speed), beta = seen.beta;
    const double least = seen.lower * speed / (beta * beta), most = seen.upper * speed / beta;
    char text[32];
    uint32_t colour;
    const char *regime = regime_of(seen, most, &colour);
    if (sounding >= 0) {
        snprintf(text, sizeof text, "%s%d", names[sounding % 12], sounding / 12 - 1);
        const float wide = canvas.text(PANEL_X, 62, 42, text, INK);
        snprintf(text, sizeof text, "%+d ct", (int)floor(bent + 0.5));
        canvas.text(PANEL_X + wide + 4, 62, 15, text, SOFT);
    }
    canvas.text(PANEL_X, 92, 16, regime, colour);
    const bool is_bowed = seen.string >= 0;
    const double level = 20.0 * log10(fmax(seen.rms, 1e-4));
    snprintf(text, sizeof text, seen.rms > SILENT ? "%d dB" : "-", (int)floor(level + 0.5));
    draw_gauge(0, "Level", text, share_of(level, -60, 0), 0, 0);
    snprintf(text, sizeof text, is_bowed ? "%d cm/s" : "-", (int)(100 * speed + 0.5));
    draw_gauge(1, "Bow speed", text, is_bowed ? share_of(speed, 0, 0.6) : 0, 0, 0);
    snprintf(text, sizeof text, is_bowed ? "%d mN" : "-", (int)(1000 * seen.force + 0.5));
    draw_gauge(2, "Bow force", text, is_bowed ? force_share(seen.force) : 0, is_bowed ? force_share(least) : 0, is_bowed ? force_share(most) : 0);
    snprintf(text, sizeof text, is_bowed ? "%d %% of the string" : "-", (int)(100 * beta + 0.5));
    draw_gauge(3, "Bow at", text, is_bowed ? share_of(beta, 0, 0.4) : 0, 0, 0);
    snprintf(text, sizeof text, "%d %%", (100 * wide + WIDTH / 2) / WIDTH);
    canvas.text(ZOOM_X, ZOOM_Y, 12, text, SOFT);
}

/* `from` and `to`: where it is good. */
void Editor::draw_gauge(int row, const char *name, const char *value, float share, float from, float to) {
    const float y = GAUGES_Y + GAUGE_HEIGHT * (float)row;
    canvas.text(PANEL_X, y + 12, 12, name, SOFT);
    canvas.text(PANEL_X + PANEL_WIDTH - canvas.text(0, 0, 12, value, INK, false), y + 12, 12, value, INK);
    canvas.box(PANEL_X, y + 18, PANEL_WIDTH, 6, 3, LINE);
    if (to > from) canvas.box(PANEL_X + PANEL_WIDTH * from, y + 18, PANEL_WIDTH * (to - from), 6, 3, GOOD, 0.45f);
    if (to > 0 && share > 0) canvas.disc(PANEL_X + PANEL_WIDTH * share, y + 21, 5, share > from && share < to ? GOOD : BAD);
    else if (share > 0) canvas.box(PANEL_X, y + 18, fmaxf(PANEL_WIDTH * share, 6), 6, 3, SOFT);
}

void Editor::draw_slider(int slider) {
    const float x = SLIDERS_X + SLIDER_STEP * (float)(slider % IN_A_ROW), y = SLIDERS_Y + SLIDER_HEIGHT * (float)(slider / IN_A_ROW);
    const float share = (float)to_unit(SLID[slider], slid[slider]);
    char value[64];
    const bool has_focus = focus == CHOOSERS + slider, is_typed = has_focus && length >= 0;
    if (is_typed) snprintf(value, sizeof value, "%s_", typed);
    else instrument.all().write(SLID[slider], slid[slider], value, sizeof value);
    const char *name = parameters[SLID[slider]].name;
    const float value_width = canvas.text(0, 0, 11, value, INK, false), room = SLIDER_WIDTH - value_width - 6;
    const float size = fminf(11, room / canvas.text(0, 0, 1, name, INK, false));
    canvas.text(x, y + 11, size, name, has_focus ? OUTER : SOFT);
    canvas.text(x + SLIDER_WIDTH - value_width, y + 11, 11, value, is_typed ? OUTER : INK);
    canvas.box(x, y + 16, SLIDER_WIDTH, 4, 2, LINE);
    canvas.disc(x + SLIDER_WIDTH * share, y + 18, 5, has_focus ? OUTER : SOFT);
}

void Editor::draw_chooser(int chooser) {
    const Parameter &p = parameters[CHOSEN[chooser]];
    const float x = CHOOSERS_X[chooser], y = CHOOSERS_Y, width = chooser_width(chooser), room = width - 2 * ARROW;
    char name[64];
    write(CHOSEN[chooser], name, sizeof name);
    const int choice = choice_of(chooser);
    canvas.text(x + 2, y - 8, 12, p.name, SOFT);
    canvas.box(x, y, width, CHOOSER_HEIGHT, 8, chooser == focus ? OUTER : LINE);
    canvas.box(x + 1.5f, y + 1.5f, width - 3, CHOOSER_HEIGHT - 3, 7, SURFACE);
    const auto centre = [&](const char *line, float at, float size) {
        const float long_at_1 = canvas.text(0, 0, 1, line, INK, false);
        size = fminf(size, room / long_at_1);
        canvas.text(x + (width - size * long_at_1) / 2, y + at, size, line, INK);
    };
    char *second = strchr(name, ' '); /* of what was changed */
    if (second) *second++ = 0, centre(second, 34, 12);
    centre(name, second ? 18 : 26, second ? 14 : 16);
    canvas.text(x + 10, y + 26, 16, "<", choice > 0 ? INK : LINE);
    canvas.text(x + width - 15, y + 26, 16, ">", choice < p.steps ? INK : LINE);
}

} /* namespace yehu */
