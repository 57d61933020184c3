/* Says what the plug-in's settings are after some changes: words are numbers of parameters with values. */
#include <stdio.h>
#include <stdlib.h>

#include "settings.hpp"

int main(int count, char **words) {
    yehu::Settings settings;
    char text[64];
    for (int i = 1; i + 1 < count; i += 2)
        settings.change(yehu::parameter_of((uint32_t)strtoul(words[i], nullptr, 10)), atof(words[i + 1]), [](int, bool) {});
    settings.describe(text, sizeof text);
    printf("%s|%d|%d|%g\n", text, settings.preset(), settings.is_changed(), settings.usual(yehu::VIBRATO));
}
