/* Keys that choose articulations in VST3 hosts: their names, and as key switches, of which Cubase and
 * MuseScore make expression maps. */
#include <string.h>

#include "vst3.hpp"

namespace yehu {

/* As ivstnoteexpression.h of Steinberg's interfaces, which sets of headers have not. */
const v3_tuid key_switches_iid = V3_ID(0x1F2F76D3, 0xBFFB4B96, 0xB99527A5, 0x5EBCCEF4);

namespace {

constexpr uint32_t BEFORE_NOTE = 0; /* it is pressed before the note */

int32_t V3_API count(void *self, int32_t bus, int16_t channel) {
    return bus == 0 && channel >= 0 && channel < CHANNELS ? switch_count(of<KEY_SWITCHES>(self)) : 0;
}

v3_result V3_API get(void *self, int32_t bus, int16_t channel, int32_t index, KeySwitch *info) {
    if (index < 0 || index >= count(self, bus, channel)) return V3_INVALID_ARG;
    memset(info, 0, sizeof *info);
    info->type = BEFORE_NOTE;
    write_text(parameters[ARTICULATION].choices[index], info->title);
    write_text(parameters[ARTICULATION].choices[index], info->short_title);
    info->lowest = info->highest = first_switch(of<KEY_SWITCHES>(self)) + index;
    info->remapped = info->unit = -1;
    return V3_OK;
}

} /* namespace */

int first_switch(const Vst3 &plugin) { return first_switches[(int)plugin.shown.value(MAPPING)]; }
int switch_count(const Vst3 &plugin) { return first_switch(plugin) < 0 ? 0 : ARTICULATIONS; }

const KeySwitches key_switches = {unknown<KEY_SWITCHES>(), count, get};

} /* namespace yehu */
