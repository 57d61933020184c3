/* Values of parameters as text, and the state, which is text too:
 *
 *     yehu 1
 *     /mapping=keyboard
 *     /playing/bow_position=0.13
 *
 * A line for each parameter, by its address; a choice by its name. What a version does not know is
 * left out as it reads, so that states open in any version. A preset or room that was changed is none, and
 * keeps its name: `/preset=vibrato, changed`. One that is not named is found by its values.
 */
#include "settings.hpp"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

namespace yehu {

namespace {
constexpr char HEADING[] = "yehu 1\n";
constexpr char CHANGED[] = ", changed";
constexpr size_t LONGEST = 64;

/* The host may have set a locale whose numbers have commas. */
char point() { return localeconv()->decimal_point[0]; }

void write_number(const char *format, double value, char *into, size_t size) {
    snprintf(into, size, format, value);
    for (char *at = into; *at; at++)
        if (*at == point()) *at = '.';
}

bool read_number(const char *text, double *value) {
    char copy[LONGEST], *end;
    snprintf(copy, sizeof copy, "%s", text);
    for (char *at = copy; *at; at++)
        if (*at == '.') *at = point();
    const double read = strtod(copy, &end);
    if (end == copy || !(read - read == 0.0)) return false;
    *value = read;
    return true;
}

const char *choice_of(int parameter, double value) {
    const Parameter &p = parameters[parameter];
    const double step = floor(value - p.lo + 0.5);
    return p.choices && step >= 0.0 && step <= p.steps ? p.choices[(int)step] : nullptr;
}

int parameter_at(const char *address, size_t length) {
    for (int i = 0; i < PARAMETERS; i++)
        if (strlen(parameters[i].address) == length && !memcmp(parameters[i].address, address, length))
            return i;
    return -1;
}

/* The preset or room that was changed, of its name with that word; or 0. */
int changed_in(int set, const char *text) {
    for (int i = 1; i <= parameters[set].steps; i++) {
        const size_t length = strlen(parameters[set].choices[i]);
        if (!strncmp(text, parameters[set].choices[i], length) && !strcmp(text + length, CHANGED)) return i;
    }
    return 0;
}
} /* namespace */

void Settings::write(int parameter, double value, char *into, size_t size) const {
    if (parameter < SETS && value < 0.5 && is_changed(parameter)) {
        snprintf(into, size, "%s%s", parameters[parameter].choices[chosen(parameter)], CHANGED);
        return;
    }
    if (const char *choice = choice_of(parameter, value)) {
        snprintf(into, size, "%s", choice);
        return;
    }
    const char *unit = parameters[parameter].unit;
    write_number(parameters[parameter].steps > 0 ? "%.0f" : "%.4g", value, into, size);
    const size_t length = strlen(into);
    if (*unit) snprintf(into + length, size - length, " %s", unit);
}

bool Settings::read(int parameter, const char *text, double *value) {
    const Parameter &p = parameters[parameter];
    if (parameter < SETS && changed_in(parameter, text) > 0) return *value = 0, true;
    for (int i = 0; p.choices && i <= p.steps; i++)
        if (!strcmp(p.choices[i], text)) return *value = p.lo + i, true;
    if (!read_number(text, value)) return false;
    if (p.choices) return *value >= p.lo && *value <= p.hi; /* a number without a choice is none */
    *value = *value < p.lo ? p.lo : *value > p.hi ? p.hi : *value;
    return true;
}

size_t Settings::save(char *into, size_t size) const {
    size_t length = 0;
    const auto add = [&](const char *text) {
        const size_t more = strlen(text);
        if (length + more < size) memcpy(into + length, text, more + 1);
        length += more;
    };
    add(HEADING);
    for (int i = 0; i < PARAMETERS; i++) {
        char word[LONGEST];
        if (parameters[i].choices) write(i, value(i), word, sizeof word);
        else write_number("%.17g", value(i), word, sizeof word);
        add(parameters[i].address);
        add("=");
        add(word);
        add("\n");
    }
    return length;
}

bool Settings::load(const char *text, size_t size) {
    const size_t heading = strcspn(HEADING, " ");
    if (size < heading || memcmp(text, HEADING, heading)) return false;
    for (int i = 0; i < PARAMETERS; i++) store(i, parameters[i].usual); /* what it does not name */
    bool is_named[SETS] = {};
    for (const char *at = text, *end = text + size; at < end;) {
        const char *line_end = (const char *)memchr(at, '\n', (size_t)(end - at));
        if (!line_end) line_end = end;
        const char *equals = (const char *)memchr(at, '=', (size_t)(line_end - at));
        const int parameter = equals ? parameter_at(at, (size_t)(equals - at)) : -1;
        char word[LONGEST];
        double value;
        if (parameter >= 0 && (size_t)(line_end - equals) <= sizeof word) {
            const size_t length = (size_t)(line_end - equals) - 1;
            memcpy(word, equals + 1, length);
            word[length] = 0;
            /* The name of a choice that this version has not is no number either. */
            const bool is_known = read(parameter, word, &value);
            if (is_known) store(parameter, value);
            if (parameter < SETS) is_named[parameter] = is_known, changed[parameter] = changed_in(parameter, word);
        }
        at = line_end + 1;
    }
    for (int set = 0; set < SETS; set++)
        if (!is_named[set]) find(set);
    return true;
}

} /* namespace yehu */
