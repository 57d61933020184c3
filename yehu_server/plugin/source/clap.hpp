/* The plug-in for CLAP hosts, as its files know it. */
#ifndef YEHU_CLAP_HPP
#define YEHU_CLAP_HPP

#include <atomic>

#include <clap/entry.h>
#include <clap/plugin-factory.h>

#include "instrument.hpp"

namespace yehu {

class Editor;

struct Plugin {
    clap_plugin_t clap;
    const clap_host_t *host;
    Instrument instrument;
    double rate;
    Editor *editor; /* null while there is none */
    clap_id timer;
    bool has_timer;
    std::atomic<int> held; /* the parameter whose slider is held in the window, or -1 */
    int gesture;           /* whose gesture has begun, as the host has heard, or -1 */
    std::atomic<double> named; /* the mapping whose keys the host knows the names of */
    std::atomic<bool> wants_names, wants_values; /* reported to the host on its main thread */
};

inline Plugin &of(const clap_plugin_t *plugin) { return *(Plugin *)plugin->plugin_data; }

/* The extension of notes, by its name, or null. */
const void *note_extension(const char *id);
/* From the thread that changes parameters: see whether keys have other names. Then, on the main
 * thread, report it to the host. */
bool watch_names(Plugin &plugin);
void report_names(const Plugin &plugin);

#ifdef YEHU_EDITOR
/* The extension of a window, by its name, or null. */
const void *editor_extension(const char *id);
void close_editor(Plugin &plugin);
#else
inline const void *editor_extension(const char *) { return nullptr; }
inline void close_editor(Plugin &) {}
#endif

} /* namespace yehu */

#endif
