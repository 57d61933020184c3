/* Draws boxes, lines and text into pixels, with smooth edges, at any scale. Of no system. */
#ifndef YEHU_CANVAS_HPP
#define YEHU_CANVAS_HPP

#include <stdint.h>

namespace yehu {

class Canvas {
public:
    ~Canvas();
    /* Pixels, and how many of them are a unit of what is drawn; false where there is no memory. */
    bool resize(int width, int height, float scale);
    int width() const { return wide; }
    int height() const { return high; }
    const uint32_t *pixels() const { return shown; } /* rows of 0x00RRGGBB */

    void fill(uint32_t colour);
    void box(float x, float y, float width, float height, float round, uint32_t colour, float alpha = 1.0f);
    /* Through points (x and y in turn), with round ends; a single one is a disc. */
    void line(const float *points, int count, float thick, uint32_t colour, float alpha = 1.0f);
    void disc(float x, float y, float radius, uint32_t colour, float alpha = 1.0f);
    /* `y` is where letters stand; the size is that of a line of text. Returns how wide it was; see
     * `draws` where only that is wanted. */
    float text(float x, float y, float size, const char *text, uint32_t colour, bool draws = true);

private:
    void cover(float ax, float ay, float bx, float by, float radius); /* pixels */
    void ink(uint32_t colour, float alpha);                           /* what was covered */
    void stroke(const char *points, int count, float x, float y, float size);

    int wide = 0, high = 0;
    float scale = 1.0f;
    uint32_t *shown = nullptr;
    uint8_t *covered = nullptr;
    int left = 0, right = -1, top = 0, bottom = -1; /* of what is covered */
};

} /* namespace yehu */

#endif
