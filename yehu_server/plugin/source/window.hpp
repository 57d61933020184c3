/* A window in that of a host, as each system has it (window_x11.cpp, window_windows.cpp): shows
 * pixels, and reports to an editor what the user does. All of it is for the host's main thread.
 */
#ifndef YEHU_WINDOW_HPP
#define YEHU_WINDOW_HPP

#include <stdint.h>

namespace yehu {

class Editor;
enum class Key { LEFT, RIGHT, UP, DOWN, NEXT, PREVIOUS, FIRST, LAST, ENTER, ESCAPE, BACK };

class Window {
public:
    ~Window() { close(); }
    bool open(Editor &editor, uintptr_t parent, int width, int height);
    void close();
    bool is_open() const { return native != nullptr; }
    uintptr_t handle() const; /* as hosts know it */
    void resize(int width, int height);
    void show(bool is_shown);
    void put(const uint32_t *pixels, int width, int height);
    /* What screen readers say of it; on X11 nothing, where they hear of windows by their toolkits only. */
    void name(const char *text);
    /* Report what has happened, where the system does not by itself. */
    void poll();
    /* Whether the system calls `Editor::tick`; else a timer of the host has to. */
    static bool has_timer();
    /* The file that can be read when something has happened, for hosts that wait for it; or -1. */
    int file() const;

private:
    struct Native;
    Native *native = nullptr;
};

} /* namespace yehu */

#endif
