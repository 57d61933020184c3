/* Says what the plug-in's settings are after some changes: words are numbers of parameters with values. */
#include <stdio.h>
#include <stdlib.h>

#include "settings.hpp"

int main(int count, char **words) {
    yehu::Settings settings;
    char text[64];
    for (int i = 1; i + 1 < count; i += 2)
        settings.change(yehu::parameter_of((uint32_t)strtoul(words[i], nullptr, 10)), atof(words[i + 1]), [](int, bool) {});
    for (int set = 0; set < yehu::SETS; set++) {
        settings.write(set, settings.value(set), text, sizeof text);
        printf("%s|%d|", text, settings.chosen(set));
    }
    printf("%g|%g\n", settings.usual(yehu::VIBRATO), settings.usual(yehu::ROOM_LEVEL));
}
