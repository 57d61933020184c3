#include "canvas.hpp"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glyphs.hpp"

namespace yehu {

namespace {
constexpr float UNIT = 0.05f;    /* of a line of text: a unit of glyphs */
constexpr float STANDS = 14.0f;  /* units of glyphs */
constexpr float THICK = 0.085f;  /* of a line of text: its strokes, */
constexpr float THINNEST = 1.1f; /* in pixels at least */
constexpr float BETWEEN = 4.0f, SPACE = 3.0f;
constexpr int STEPS = 6; /* lines of a curve between two of its points */

float clamp(float value, float lo, float hi) { return value < lo ? lo : value > hi ? hi : value; }

uint32_t mixed(uint32_t below, uint32_t colour, float share) {
    uint32_t made = 0;
    for (int at = 0; at < 24; at += 8) {
        const float old = (float)(below >> at & 255), other = (float)(colour >> at & 255);
        made |= (uint32_t)(old + share * (other - old) + 0.5f) << at;
    }
    return made;
}

static_assert(sizeof GLYPHS / sizeof *GLYPHS == 'z' - ' ' + 1, "a glyph for each letter");
int digit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }
const char *glyph_of(char c) { return c >= ' ' && c <= 'z' ? GLYPHS[c - ' '] : ""; }

float width_of(const char *glyph) {
    int most = 0, place = 0;
    for (; *glyph; glyph++) {
        if (strchr(" -~o", *glyph)) place = 0;
        else if (place++ % 2 == 0 && digit(*glyph) > most) most = digit(*glyph);
    }
    return (float)most;
}
} /* namespace */

Canvas::~Canvas() {
    free(shown);
    free(covered);
}

bool Canvas::resize(int width, int height, float pixels) {
    const size_t count = (size_t)width * (size_t)height;
    free(shown);
    free(covered);
    shown = (uint32_t *)calloc(count, sizeof *shown);
    covered = (uint8_t *)calloc(count, 1);
    wide = shown && covered ? width : 0, high = shown && covered ? height : 0;
    scale = pixels;
    return wide > 0;
}

void Canvas::fill(uint32_t colour) {
    for (int i = 0; i < wide * high; i++) shown[i] = colour;
}

void Canvas::box(float x, float y, float width, float height, float round, uint32_t colour, float alpha) {
    const float r = scale * round, cx = scale * (x + width / 2), cy = scale * (y + height / 2);
    const float half_x = scale * width / 2 - r, half_y = scale * height / 2 - r;
    const int x0 = (int)clamp(cx - half_x - r - 1, 0, (float)wide), x1 = (int)clamp(cx + half_x + r + 2, 0, (float)wide);
    const int y0 = (int)clamp(cy - half_y - r - 1, 0, (float)high), y1 = (int)clamp(cy + half_y + r + 2, 0, (float)high);
    for (int py = y0; py < y1; py++)
        for (int px = x0; px < x1; px++) {
            const float dx = fabsf((float)px + 0.5f - cx) - half_x, dy = fabsf((float)py + 0.5f - cy) - half_y;
            const float ox = fmaxf(dx, 0.0f), oy = fmaxf(dy, 0.0f);
            const float away = sqrtf(ox * ox + oy * oy) + fminf(fmaxf(dx, dy), 0.0f) - r;
            const float share = alpha * clamp(0.5f - away, 0.0f, 1.0f);
            uint32_t &pixel = shown[py * wide + px];
            if (share > 0.0f) pixel = mixed(pixel, colour, share);
        }
}

void Canvas::cover(float ax, float ay, float bx, float by, float radius) {
    const float reach = radius + 1.0f, dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
    const int x0 = (int)clamp(fminf(ax, bx) - reach, 0, (float)wide), x1 = (int)clamp(fmaxf(ax, bx) + reach + 1, 0, (float)wide);
    const int y0 = (int)clamp(fminf(ay, by) - reach, 0, (float)high), y1 = (int)clamp(fmaxf(ay, by) + reach + 1, 0, (float)high);
    if (right < left) left = x0, right = x1 - 1, top = y0, bottom = y1 - 1;
    left = x0 < left ? x0 : left, right = x1 > right ? x1 - 1 : right;
    top = y0 < top ? y0 : top, bottom = y1 > bottom ? y1 - 1 : bottom;
    for (int py = y0; py < y1; py++)
        for (int px = x0; px < x1; px++) {
            const float x = (float)px + 0.5f - ax, y = (float)py + 0.5f - ay;
            const float along = square > 0.0f ? clamp((x * dx + y * dy) / square, 0.0f, 1.0f) : 0.0f;
            const float ox = x - along * dx, oy = y - along * dy;
            const float share = clamp(radius + 0.5f - sqrtf(ox * ox + oy * oy), 0.0f, 1.0f);
            uint8_t &most = covered[py * wide + px];
            if (255.0f * share > (float)most) most = (uint8_t)(255.0f * share);
        }
}

void Canvas::ink(uint32_t colour, float alpha) {
    for (int y = top; y <= bottom; y++)
        for (int x = left; x <= right; x++) {
            uint8_t &share = covered[y * wide + x];
            if (share) shown[y * wide + x] = mixed(shown[y * wide + x], colour, alpha * (float)share / 255.0f);
            share = 0;
        }
    right = bottom = -1, left = top = 0;
}

void Canvas::line(const float *points, int count, float thick, uint32_t colour, float alpha) {
    for (int i = 0; i < count; i++) {
        const float *from = points + 2 * (i > 0 ? i - 1 : 0), *to = points + 2 * i;
        if (i > 0 || count == 1) cover(scale * from[0], scale * from[1], scale * to[0], scale * to[1], scale * thick / 2);
    }
    ink(colour, alpha);
}

void Canvas::disc(float x, float y, float radius, uint32_t colour, float alpha) {
    const float point[] = {x, y};
    line(point, 1, 2 * radius, colour, alpha);
}

/* One stroke of a glyph. Curves are quadratic between the middles of their points' sides. */
void Canvas::stroke(const char *points, int count, float x, float y, float size) {
    const float unit = scale * UNIT * size, radius = fmaxf(scale * THICK * size, THINNEST) / 2;
    const bool is_closed = points[-1] == 'o', is_line = points[-1] == '-';
    const auto px = [&](int i) { return scale * x + unit * (float)digit(points[2 * (i % count)]); };
    const auto py = [&](int i) { return scale * y + unit * ((float)digit(points[2 * (i % count) + 1]) - STANDS); };
    if (is_line) {
        for (int i = 0; i < count; i++)
            if (i > 0 || count == 1) cover(px(i > 0 ? i - 1 : 0), py(i > 0 ? i - 1 : 0), px(i), py(i), radius);
        return;
    }
    for (int i = is_closed ? 0 : 1; i < (is_closed ? count : count - 1); i++) {
        const bool from_end = !is_closed && i == 1, to_end = !is_closed && i == count - 2;
        const int before = (i + count - 1) % count;
        const float ax = from_end ? px(0) : (px(before) + px(i)) / 2, ay = from_end ? py(0) : (py(before) + py(i)) / 2;
        const float bx = to_end ? px(i + 1) : (px(i) + px(i + 1)) / 2, by = to_end ? py(i + 1) : (py(i) + py(i + 1)) / 2;
        float lx = ax, ly = ay;
        for (int step = 1; step <= STEPS; step++) {
            const float t = (float)step / STEPS, s = 1.0f - t;
            const float nx = s * s * ax + 2 * s * t * px(i) + t * t * bx, ny = s * s * ay + 2 * s * t * py(i) + t * t * by;
            cover(lx, ly, nx, ny, radius);
            lx = nx, ly = ny;
        }
    }
}

float Canvas::text(float x, float y, float size, const char *text, uint32_t colour, bool draws) {
    const float start = x;
    for (; *text; text++) {
        const char *glyph = glyph_of(*text);
        for (const char *at = glyph; draws && *at;) {
            const char *end = strchr(at, ' ');
            if (!end) end = at + strlen(at);
            stroke(at + 1, (int)(end - at - 1) / 2, x, y, size);
            at = *end ? end + 1 : end;
        }
        x += UNIT * size * (*glyph ? width_of(glyph) + BETWEEN : SPACE + BETWEEN);
    }
    if (draws) ink(colour, 1.0f);
    return x - start;
}

} /* namespace yehu */
