/* Parameters as numbers from 0 to 1 and as text, and the state, which is text too:
 *
 *     yehu 1
 *     /mapping=keyboard
 *     /playing/bow_position=0.13
 *
 * A line for each parameter, by its address; a choice by its name. What a version does not know is
 * left out as it reads, so that states open in any version.
 */
#include "instrument.hpp"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

namespace yehu {

namespace {
constexpr char HEADING[] = "yehu 1\n";
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
    const int choice = (int)floor(value + 0.5);
    return p.choices && choice >= 0 && choice <= p.steps ? p.choices[choice] : nullptr;
}

int parameter_at(const char *address, size_t length) {
    for (int i = 0; i < PARAMETERS; i++)
        if (strlen(parameters[i].address) == length && !memcmp(parameters[i].address, address, length))
            return i;
    return -1;
}
} /* namespace */

int parameter_of(uint32_t number) {
    for (int i = 0; i < PARAMETERS; i++)
        if (parameters[i].number == number) return i;
    return -1;
}

double to_unit(int parameter, double value) {
    const Parameter &p = parameters[parameter];
    value = value < p.lo ? p.lo : value > p.hi ? p.hi : value;
    return p.exponential ? log(value / p.lo) / log(p.hi / p.lo) : (value - p.lo) / (p.hi - p.lo);
}

double from_unit(int parameter, double unit) {
    const Parameter &p = parameters[parameter];
    unit = unit < 0.0 ? 0.0 : unit > 1.0 ? 1.0 : unit;
    if (p.steps > 0) return p.lo + floor(unit * p.steps + 0.5);
    const double value = p.exponential ? p.lo * pow(p.hi / p.lo, unit) : p.lo + unit * (p.hi - p.lo);
    /* Hosts that keep numbers of 32 bits give the usual value back as it was. */
    return fabs(unit - to_unit(parameter, p.usual)) < 1e-7 ? p.usual : value;
}

void write_value(int parameter, double value, char *into, size_t size) {
    if (const char *choice = choice_of(parameter, value)) {
        snprintf(into, size, "%s", choice);
        return;
    }
    const char *unit = parameters[parameter].unit;
    write_number(parameters[parameter].steps > 0 ? "%.0f" : "%.4g", value, into, size);
    const size_t length = strlen(into);
    if (*unit) snprintf(into + length, size - length, " %s", unit);
}

bool read_value(int parameter, const char *text, double *value) {
    const Parameter &p = parameters[parameter];
    for (int i = 0; p.choices && i <= p.steps; i++)
        if (!strcmp(p.choices[i], text)) return *value = i, true;
    if (!read_number(text, value)) return false;
    *value = *value < p.lo ? p.lo : *value > p.hi ? p.hi : *value;
    return true;
}

size_t Instrument::save(char *into, size_t size) const {
    size_t length = 0;
    const auto add = [&](const char *text) {
        const size_t more = strlen(text);
        if (length + more < size) memcpy(into + length, text, more + 1);
        length += more;
    };
    add(HEADING);
    for (int i = 0; i < PARAMETERS; i++) {
        char number[LONGEST];
        write_number("%.17g", value(i), number, sizeof number);
        const char *choice = choice_of(i, value(i));
        add(parameters[i].address);
        add("=");
        add(choice ? choice : number);
        add("\n");
    }
    return length;
}

bool Instrument::load(const char *text, size_t size) {
    const size_t heading = strcspn(HEADING, " ");
    if (size < heading || memcmp(text, HEADING, heading)) return false;
    double before[PARAMETERS];
    for (int i = 0; i < PARAMETERS; i++) { /* what it does not name is as at first */
        before[i] = value(i);
        store(i, parameters[i].usual);
    }
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
            if (read_value(parameter, word, &value)) store(parameter, value);
        }
        at = line_end + 1;
    }
    for (int i = 0; i < PARAMETERS; i++)
        if (i != PRESET && value(i) != before[i]) flag(set_bits, i);
    return true;
}

} /* namespace yehu */
