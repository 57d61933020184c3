/* A small CLAP host on Windows: opens the plug-in's window, presses keys, and prints its name after each.
 *
 *     windows_window PLUGIN KEYS NUMBER
 *
 * KEYS: t for tab, r for return, e for escape; others are typed. The last line is the parameter's value.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <clap/entry.h>
#include <clap/ext/gui.h>
#include <clap/ext/params.h>
#include <clap/plugin-factory.h>
#include <windows.h>

static void CLAP_ABI nothing(const clap_host_t *host) { (void)host; }
static const void *CLAP_ABI extension(const clap_host_t *host, const char *id) { return (void)host, (void)id, NULL; }

static void let_run(DWORD ms) {
    MSG message;
    for (const DWORD end = GetTickCount() + ms; GetTickCount() < end; Sleep(1))
        while (PeekMessageA(&message, NULL, 0, 0, PM_REMOVE)) DispatchMessageA(&message);
}

int main(int words, char **word) {
    HMODULE library = words == 4 ? LoadLibraryA(word[1]) : NULL;
    const clap_plugin_entry_t *entry = library ? (const clap_plugin_entry_t *)(void *)GetProcAddress(library, "clap_entry") : NULL;
    if (!entry || !entry->init(word[1])) return 3;
    const clap_plugin_factory_t *factory = entry->get_factory(CLAP_PLUGIN_FACTORY_ID);
    const clap_host_t host = {CLAP_VERSION, NULL, "host", "", "", "1", extension, nothing, nothing, nothing};
    const clap_plugin_t *plugin = factory->create_plugin(factory, &host, factory->get_plugin_descriptor(factory, 0)->id);
    if (!plugin || !plugin->init(plugin) || !plugin->activate(plugin, 48000.0, 1, 256)) return 4;
    const clap_plugin_gui_t *gui = plugin->get_extension(plugin, CLAP_EXT_GUI);
    const clap_plugin_params_t *params = plugin->get_extension(plugin, CLAP_EXT_PARAMS);
    uint32_t width, height;
    if (!gui || !gui->create(plugin, CLAP_WINDOW_API_WIN32, false) || !gui->get_size(plugin, &width, &height)) return 5;
    HWND outer = CreateWindowA("STATIC", "host", WS_POPUP | WS_VISIBLE, 0, 0, (int)width, (int)height, NULL, NULL, NULL, NULL);
    const clap_window_t parent = {CLAP_WINDOW_API_WIN32, {.win32 = outer}};
    if (!gui->set_parent(plugin, &parent) || !gui->show(plugin)) return 6;
    HWND inner = GetWindow(outer, GW_CHILD);
    for (const char *key = word[2]; *key; key++) {
        const char *found = strchr("t\tr\re\x1b", *key);
        if (found) SendMessageA(inner, WM_KEYDOWN, (WPARAM)(found[1] == '\t' ? VK_TAB : found[1] == '\r' ? VK_RETURN : VK_ESCAPE), 0);
        SendMessageA(inner, WM_CHAR, (WPARAM)(found ? found[1] : *key), 0);
        let_run(100); /* its timer is due */
        char name[160] = "";
        GetWindowTextA(inner, name, sizeof name);
        printf("%s\n", name);
    }
    double value = 0.0;
    params->get_value(plugin, (clap_id)strtoul(word[3], NULL, 10), &value);
    printf("%g\n", value);
    gui->destroy(plugin);
    DestroyWindow(outer);
    plugin->deactivate(plugin), plugin->destroy(plugin), entry->deinit();
    return 0;
}
