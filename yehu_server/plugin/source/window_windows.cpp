/* The window on Windows, which has a timer of its own. */
#include "window.hpp"

#include <stdlib.h>
#include <windows.h>
#include <windowsx.h>

#include "editor.hpp"

namespace yehu {

namespace {
constexpr char CLASS[] = "yehu-server.yehu.editor";
constexpr UINT_PTR TIMER = 1;

bool key_of(WPARAM code, Key *key) {
    const struct { WPARAM code; Key key; } known[] = {
        {VK_LEFT, Key::LEFT},       {VK_UP, Key::UP},     {VK_RIGHT, Key::RIGHT},   {VK_DOWN, Key::DOWN},
        {VK_HOME, Key::FIRST},      {VK_END, Key::LAST},  {VK_TAB, Key::NEXT},      {VK_RETURN, Key::ENTER},
        {VK_ESCAPE, Key::ESCAPE},   {VK_BACK, Key::BACK},
    };
    for (const auto &each : known)
        if (each.code == code) return *key = each.key, true;
    return false;
}
} /* namespace */

struct Window::Native {
    Editor *editor;
    HWND window;
    const uint32_t *pixels;
    int width, height;

    static LRESULT CALLBACK receive(HWND window, UINT message, WPARAM one, LPARAM two);
    void paint() const;
};

bool Window::has_timer() { return true; }

int Window::file() const { return -1; }

bool Window::open(Editor &editor, uintptr_t parent, int width, int height) {
    if (native) return false;
    HMODULE self = nullptr; /* this library: others of its kind may be loaded */
    GetModuleHandleExA(GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT,
                       (LPCSTR)&Native::receive, &self);
    WNDCLASSEXA kind = {};
    kind.cbSize = sizeof kind, kind.lpfnWndProc = Native::receive, kind.hInstance = self;
    kind.hCursor = LoadCursorA(nullptr, (LPCSTR)IDC_ARROW), kind.lpszClassName = CLASS;
    const bool is_first = RegisterClassExA(&kind) != 0; /* of a library; its code stays while it is loaded */
    Native *made = (Native *)calloc(1, sizeof *made);
    if (!made || (!is_first && GetLastError() != ERROR_CLASS_ALREADY_EXISTS)) return free(made), false;
    const HWND window = CreateWindowExA(0, CLASS, Editor::NAME, WS_CHILD | WS_VISIBLE, 0, 0, width, height, (HWND)parent,
                                        nullptr, self, nullptr);
    if (!window) return free(made), false;
    *made = {&editor, window, nullptr, 0, 0};
    native = made;
    SetWindowLongPtrA(window, GWLP_USERDATA, (LONG_PTR)made);
    show(true);
    return true;
}

void Window::close() {
    if (!native) return;
    SetWindowLongPtrA(native->window, GWLP_USERDATA, 0);
    DestroyWindow(native->window);
    free(native);
    native = nullptr;
}

uintptr_t Window::handle() const { return native ? (uintptr_t)native->window : 0; }

void Window::resize(int width, int height) {
    native->pixels = nullptr; /* until there are others */
    SetWindowPos(native->window, nullptr, 0, 0, width, height, SWP_NOMOVE | SWP_NOZORDER | SWP_NOACTIVATE);
}

void Window::show(bool is_shown) {
    if (!native) return;
    ShowWindow(native->window, is_shown ? SW_SHOWNA : SW_HIDE);
    if (is_shown) SetTimer(native->window, TIMER, Editor::INTERVAL_MS, nullptr);
    else KillTimer(native->window, TIMER);
}

void Window::put(const uint32_t *pixels, int width, int height) {
    native->pixels = pixels, native->width = width, native->height = height;
    InvalidateRect(native->window, nullptr, FALSE);
}

/* Which is the window's own name, by which Windows reports it and its changes to screen readers. */
void Window::name(const char *text) { SetWindowTextA(native->window, text); }

void Window::poll() {}

void Window::Native::paint() const {
    PAINTSTRUCT paint;
    const HDC into = BeginPaint(window, &paint);
    BITMAPINFO about = {};
    about.bmiHeader = {sizeof about.bmiHeader, width, -height, 1, 32, BI_RGB, 0, 0, 0, 0, 0};
    if (pixels)
        SetDIBitsToDevice(into, 0, 0, (DWORD)width, (DWORD)height, 0, 0, 0, (UINT)height, pixels, &about, DIB_RGB_COLORS);
    EndPaint(window, &paint);
}

LRESULT CALLBACK Window::Native::receive(HWND window, UINT message, WPARAM one, LPARAM two) {
    auto *native = (Native *)GetWindowLongPtrA(window, GWLP_USERDATA);
    POINT place = {GET_X_LPARAM(two), GET_Y_LPARAM(two)};
    Key key;
    if (!native) return DefWindowProcA(window, message, one, two);
    switch (message) {
    case WM_TIMER: native->editor->tick(); return 0;
    case WM_PAINT: native->paint(); return 0;
    case WM_ERASEBKGND: return 1;
    case WM_GETDLGCODE: return DLGC_WANTARROWS | DLGC_WANTTAB | DLGC_WANTCHARS;
    case WM_LBUTTONDOWN:
        SetFocus(window);
        SetCapture(window);
        native->editor->press(place.x, place.y);
        return 0;
    case WM_LBUTTONUP: ReleaseCapture(); return 0;
    case WM_CAPTURECHANGED: native->editor->release(); return 0;
    case WM_MOUSEMOVE:
        if (one & MK_LBUTTON) native->editor->drag(place.x, place.y);
        return 0;
    case WM_MOUSEWHEEL: /* its place is of the screen */
        ScreenToClient(window, &place);
        native->editor->turn(place.x, place.y, GET_WHEEL_DELTA_WPARAM(one) > 0 ? -1 : 1);
        return 0;
    case WM_KEYDOWN:
        if (!key_of(one, &key)) break;
        native->editor->key(key == Key::NEXT && GetKeyState(VK_SHIFT) < 0 ? Key::PREVIOUS : key);
        return 0;
    case WM_CHAR:
        if (one < 128) native->editor->type((char)one);
        return 0;
    }
    return DefWindowProcA(window, message, one, two);
}

} /* namespace yehu */
