/* The entry points of the VST3 plug-in: its factory, its object, its state as a stream. */
#include "vst3.hpp"

#include <new>
#include <stdlib.h>
#include <string.h>

namespace yehu {

namespace {
const v3_tuid identity = YEHU_VST3_ID;
constexpr int32_t MANY = 0x7FFFFFFF, MAX_STATE = 1 << 16;
} /* namespace */

void write_text(const char *text, int16_t *into) {
    int at = 0;
    for (; text[at] && at < 127; at++) into[at] = (unsigned char)text[at];
    into[at] = 0;
}

v3_result query(Vst3 &plugin, const v3_tuid id, void **into) {
    const struct { const uint8_t *id; int place; } known[] = {
        {v3_funknown_iid, COMPONENT},          {v3_plugin_base_iid, COMPONENT},
        {v3_component_iid, COMPONENT},         {v3_audio_processor_iid, PROCESSOR},
        {v3_edit_controller_iid, CONTROLLER},  {v3_midi_mapping_iid, CONTROLLERS_OF_MIDI},
        {v3_unit_information_iid, UNITS},      {v3_process_context_requirements_iid, REQUIREMENTS},
        {key_switches_iid, KEY_SWITCHES},
    };
    for (const auto &each : known)
        if (v3_tuid_match(each.id, id)) {
            plugin.references++;
            *into = &plugin.tables[each.place];
            return V3_OK;
        }
    *into = nullptr;
    return V3_NO_INTERFACE;
}

uint32_t unref(Vst3 &plugin) {
    const uint32_t left = --plugin.references;
    if (left == 0) {
        if (plugin.handler) v3_cpp_obj_unref(plugin.handler);
        plugin.~Vst3();
        free(&plugin);
    }
    return left;
}

bool read_state(Vst3 &plugin, v3_bstream **stream) {
    char *text = (char *)malloc(MAX_STATE);
    if (!text) return false;
    int32_t length = 0;
    for (int32_t more = 0; length < MAX_STATE; length += more)
        if (v3_cpp_obj(stream)->read(stream, text + length, MAX_STATE - length, &more) != V3_OK || more <= 0)
            break;
    const bool is_right = plugin.instrument.load(text, (size_t)length);
    free(text);
    plugin.shown.copy(plugin.instrument.all());
    for (auto &each : plugin.awaited) each = false;
    return is_right;
}

/* What the host has set and not processed yet is state, too. */
bool write_state(const Vst3 &plugin, v3_bstream **stream) {
    bool is_late = false;
    for (const auto &each : plugin.awaited) is_late |= each;
    const Settings &settings = is_late ? plugin.shown : plugin.instrument.all();
    const size_t size = settings.save(nullptr, 0) + 1;
    char *text = (char *)malloc(size);
    if (!text) return false;
    settings.save(text, size);
    int32_t done = 0, more = 0;
    const int32_t length = (int32_t)strlen(text);
    for (; done < length; done += more)
        if (v3_cpp_obj(stream)->write(stream, text + done, length - done, &more) != V3_OK || more <= 0) break;
    free(text);
    return done == length;
}

namespace {

/* -- the factory ------------------------------------------------------------------------------ */

struct Factory { const void *table; };

v3_result V3_API query_factory(void *self, const v3_tuid id, void **into) {
    const bool is_known = v3_tuid_match(id, v3_funknown_iid) || v3_tuid_match(id, v3_plugin_factory_iid) ||
                          v3_tuid_match(id, v3_plugin_factory_2_iid) || v3_tuid_match(id, v3_plugin_factory_3_iid);
    *into = is_known ? self : nullptr;
    return is_known ? V3_OK : V3_NO_INTERFACE;
}

uint32_t V3_API stay(void *) { return 1; }

v3_result V3_API get_info(void *, v3_factory_info *info) {
    memset(info, 0, sizeof *info);
    strcpy(info->vendor, "yehu-server");
    info->flags = 0x10; /* of Unicode */
    return V3_OK;
}

int32_t V3_API count_classes(void *) { return 1; }

template <class Info> bool begin_class(int32_t index, Info *info) {
    if (index != 0) return false;
    memset(info, 0, sizeof *info);
    memcpy(info->class_id, identity, sizeof identity);
    info->cardinality = MANY;
    strcpy(info->category, "Audio Module Class");
    return true;
}

constexpr char KINDS[] = "Instrument|Synth", SDK[] = "VST 3.7.4";

v3_result V3_API get_class(void *, int32_t index, v3_class_info *info) {
    if (!begin_class(index, info)) return V3_INVALID_ARG;
    strcpy(info->name, "Yehu");
    return V3_OK;
}

v3_result V3_API get_class_2(void *, int32_t index, v3_class_info_2 *info) {
    if (!begin_class(index, info)) return V3_INVALID_ARG;
    strcpy(info->name, "Yehu");
    strcpy(info->sub_categories, KINDS);
    strcpy(info->vendor, "yehu-server");
    strcpy(info->version, YEHU_VERSION);
    strcpy(info->sdk_version, SDK);
    return V3_OK;
}

v3_result V3_API get_class_3(void *, int32_t index, v3_class_info_3 *info) {
    if (!begin_class(index, info)) return V3_INVALID_ARG;
    write_text("Yehu", info->name);
    strcpy(info->sub_categories, KINDS);
    write_text("yehu-server", info->vendor);
    write_text(YEHU_VERSION, info->version);
    write_text(SDK, info->sdk_version);
    return V3_OK;
}

v3_result V3_API set_host(void *, v3_funknown **) { return V3_NOT_IMPLEMENTED; }

v3_result V3_API create(void *, const v3_tuid wanted, const v3_tuid id, void **into) {
    *into = nullptr;
    if (!v3_tuid_match(wanted, identity)) return V3_NO_INTERFACE;
    void *memory = malloc(sizeof(Vst3));
    if (!memory) return V3_NOMEM;
    Vst3 *made = new (memory) Vst3{};
    const void *tables[] = {&component, &processor, &requirements, &controller, &controllers_of_midi, &units,
                            &key_switches};
    memcpy(made->tables, tables, sizeof tables);
    made->references = 1, made->rate = 48000.0;
    const v3_result result = query(*made, id, into);
    unref(*made);
    return result;
}

const v3_plugin_factory_cpp factory_table = {{query_factory, stay, stay},
                                             {get_info, count_classes, get_class, create},
                                             {get_class_2},
                                             {get_class_3, set_host}};
Factory factory = {&factory_table};

} /* namespace */
} /* namespace yehu */

#ifdef _WIN32
#define YEHU_EXPORT extern "C" __declspec(dllexport)
#else
#define YEHU_EXPORT extern "C" __attribute__((visibility("default")))
#endif

YEHU_EXPORT const void *V3_API GetPluginFactory();
const void *V3_API GetPluginFactory() { return &yehu::factory; }

#if defined(_WIN32)
YEHU_EXPORT bool InitDll();
YEHU_EXPORT bool ExitDll();
bool InitDll() { return true; }
bool ExitDll() { return true; }
#elif defined(__APPLE__)
YEHU_EXPORT bool bundleEntry(void *);
YEHU_EXPORT bool bundleExit();
bool bundleEntry(void *) { return true; }
bool bundleExit() { return true; }
#else
YEHU_EXPORT bool ModuleEntry(void *);
YEHU_EXPORT bool ModuleExit();
bool ModuleEntry(void *) { return true; }
bool ModuleExit() { return true; }
#endif
