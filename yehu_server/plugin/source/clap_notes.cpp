/* Notes in CLAP hosts: their port, and the names of the keys that choose articulations. */
#include "clap.hpp"

#include <string.h>

#include <clap/ext/note-ports.h>

namespace yehu {

namespace {

uint32_t CLAP_ABI count_ports(const clap_plugin_t *, bool is_input) { return is_input ? 1 : 0; }

bool CLAP_ABI get_port(const clap_plugin_t *, uint32_t index, bool is_input, clap_note_port_info_t *info) {
    if (!is_input || index > 0) return false;
    const uint32_t all = CLAP_NOTE_DIALECT_CLAP | CLAP_NOTE_DIALECT_MIDI | CLAP_NOTE_DIALECT_MIDI_MPE;
    *info = {0, all, CLAP_NOTE_DIALECT_CLAP, "Yehu"};
    return true;
}

/* As clap/ext/note-name.h, which older sets of headers have not. */
constexpr const char *NAMES = "clap.note-name";
struct Name { char name[CLAP_NAME_SIZE]; int16_t port, key, channel; };
struct HostNames { void(CLAP_ABI *changed)(const clap_host_t *host); };

uint32_t CLAP_ABI count_names(const clap_plugin_t *plugin) {
    return first_switches[(int)of(plugin).instrument.value(MAPPING)] < 0 ? 0 : ARTICULATIONS;
}

bool CLAP_ABI get_name(const clap_plugin_t *plugin, uint32_t index, Name *into) {
    if (index >= count_names(plugin)) return false;
    const int first = first_switches[(int)of(plugin).instrument.value(MAPPING)];
    memset(into, 0, sizeof *into);
    strncpy(into->name, parameters[ARTICULATION].choices[index], sizeof into->name - 1);
    into->port = into->channel = -1, into->key = (int16_t)(first + (int)index);
    return true;
}

const clap_plugin_note_ports_t ports = {count_ports, get_port};
const struct {
    uint32_t(CLAP_ABI *count)(const clap_plugin_t *);
    bool(CLAP_ABI *get)(const clap_plugin_t *, uint32_t, Name *);
} names = {count_names, get_name};

} /* namespace */

const void *note_extension(const char *id) {
    return !strcmp(id, CLAP_EXT_NOTE_PORTS) ? (const void *)&ports : !strcmp(id, NAMES) ? &names : nullptr;
}

/* A mapping may have other keys. */
bool watch_names(Plugin &plugin) {
    const double mapping = plugin.instrument.value(MAPPING);
    return plugin.named.exchange(mapping) != mapping;
}

void report_names(const Plugin &plugin) {
    const auto *listener = (const HostNames *)plugin.host->get_extension(plugin.host, NAMES);
    if (listener && listener->changed) listener->changed(plugin.host);
}

} /* namespace yehu */
