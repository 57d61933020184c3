/* The values of all parameters, and what comes with a change of one: a preset, a room and a mapping set others,
 * and a preset or room is none as long as one of its values is another. Plug-in and host each have one, where a
 * format has them apart (VST3). Values may be read from any thread.
 */
#ifndef YEHU_SETTINGS_HPP
#define YEHU_SETTINGS_HPP

#include <atomic>
#include <stddef.h>
#include <stdint.h>

#include "carried.h"

namespace yehu {

/* The parameter of a number, or -1. */
int parameter_of(uint32_t number);
/* 0 to 1, along the parameter's curve, and back. */
double to_unit(int parameter, double value);
double from_unit(int parameter, double unit);
/* Whether values are the same to a host that keeps numbers of 32 bits. */
bool is_same(int parameter, double one, double other);

class Settings {
public:
    Settings();
    double value(int parameter) const { return values[parameter].load(std::memory_order_relaxed); }
    /* The preset or room that was chosen last, also where values of it are others now; or 0. */
    int chosen(int set) const { return is_changed(set) ? changed[set].load() : (int)value(set); }
    bool is_changed(int set) const { return changed[set] > 0; }
    /* The value of a parameter in the preset or room that was chosen last, or else its own usual one. */
    double usual(int parameter) const;
    void copy(const Settings &other);
    void store(int parameter, double value);
    /* Store a value, and those that come with it; `each` of them, by parameter and whether it is another
     * value than before: first the parameter itself. */
    template <class Each> void change(int parameter, double value, Each each);

    /* A value as text, and a text's value; whatever the locale is. A preset that is none has the name of
     * the one that was changed. */
    void write(int parameter, double value, char *into, size_t size) const;
    static bool read(int parameter, const char *text, double *value);
    /* State as text; `save` returns its length, which may be more than `size`. */
    size_t save(char *into, size_t size) const;
    bool load(const char *text, size_t size);

private:
    int count_changed(int set, int choice) const;
    void find(int set);

    std::atomic<double> values[PARAMETERS];
    std::atomic<int> changed[SETS]; /* the preset or room that was changed, or 0 */
};

template <class Each> void Settings::change(int parameter, double value, Each each) {
    if (!(value - value == 0.0)) return; /* no finite number */
    const auto move = [&](int other, double to) {
        const double before = this->value(other);
        if (!is_same(other, to, before)) store(other, to);
        each(other, this->value(other) != before);
    };
    const double before = this->value(parameter);
    move(parameter, value);
    if (before == this->value(parameter)) return;
    const int choice = (int)this->value(parameter);
    if (parameter < SETS) {
        const Values &now = sets[parameter][choice];
        changed[parameter] = 0;
        for (int i = 0; i < now.count; i++) move(now.values[i].parameter, now.values[i].value);
        return;
    }
    if (parameter == MAPPING) {
        const Values &old = starts[(int)before], &now = starts[choice];
        for (int i = 0; i < old.count; i++)
            move(old.values[i].parameter, parameters[old.values[i].parameter].usual);
        for (int i = 0; i < now.count; i++) move(now.values[i].parameter, now.values[i].value);
    }
    for (int set = 0; set < SETS; set++) {
        const int last = chosen(set);
        const bool is_whole = count_changed(set, last) == 0;
        if (is_whole != is_changed(set)) continue;
        changed[set] = is_whole ? 0 : last;
        move(set, is_whole ? last : 0);
    }
}

} /* namespace yehu */

#endif
